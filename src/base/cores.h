/* The number of cores that this process may use. */
#ifndef HOODOO_CORES_H
#define HOODOO_CORES_H

#include <sched.h>

/* From the CPU affinity, at least 1: a scheduler may assign a job fewer cores than the machine has. */
static inline int cores(void)
{
    cpu_set_t set;
    int n = sched_getaffinity(0, sizeof set, &set) == 0 ? CPU_COUNT(&set) : 0;
    return n > 0 ? n : 1;
}

#endif
