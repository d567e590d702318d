/* Time that passes, whatever is done to the wall clock. */
#ifndef HOODOO_CLOCK_H
#define HOODOO_CLOCK_H

#include <time.h>

/* s, from some beginning. */
static inline double clock_seconds(void)
{
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

/* s of the processors' time that this process has had, in all of its threads: what a busy machine leaves alone. */
static inline double clock_cpu_seconds(void)
{
    struct timespec t;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

#endif
