/* Clocks that do not depend on the time of day. */
#ifndef HOODOO_CLOCK_H
#define HOODOO_CLOCK_H

#include <time.h>

/* Monotonic time in seconds, from an arbitrary origin. */
static inline double clock_seconds(void)
{
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

/* CPU time in seconds that all threads of this process have used; other load on the machine does not count. */
static inline double clock_cpu_seconds(void)
{
    struct timespec t;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

#endif
