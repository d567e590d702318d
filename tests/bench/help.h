/* What benches have in common. */
#ifndef HOODOO_BENCH_HELP_H
#define HOODOO_BENCH_HELP_H

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

#include "base/clock.h"
#include "base/status.h"

/* s of the processors' time, of all threads: what a busy machine leaves alone. */
static inline double cpu_seconds(void)
{
    struct timespec t;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

/* A bench that cannot go on ends. */
static inline void check(status st)
{
    if (st == OK)
        return;
    fprintf(stderr, "%s: %s\n", program_invocation_short_name, status_message());
    exit((int)st);
}

static inline void *need(size_t n, size_t size)
{
    void *memory = calloc(n, size);
    if (!memory)
        check(fail(E_MEMORY, "no memory for %zu items", n));
    return memory;
}

#endif
