/* The limits behind memory_available() of memory.h: MemAvailable, the limits of the process's control groups (version 1 and 2,
 * including all parent groups), and its resource limits (ulimit -v, -d). Memory used by the page cache counts as free. */
#ifndef HOODOO_MEMORY_LIMITS_H
#define HOODOO_MEMORY_LIMITS_H

#include <stddef.h>

/* memory_available() of a machine whose /proc and /sys are below the folder `root` ("" is this machine); SIZE_MAX if there is no
 * limit. For tests. */
size_t memory_available_below(const char *root);

/* Resident memory of this process, including libraries, in bytes; 0 if unknown. */
size_t memory_resident(void);

#endif
