/* What benches have in common. */
#ifndef HOODOO_BENCH_HELP_H
#define HOODOO_BENCH_HELP_H

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>

#include "base/clock.h"
#include "base/status.h"

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
