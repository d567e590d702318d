/* Heap allocation that reports failure as a status and checks the size for overflow. */
#ifndef HOODOO_MEMORY_H
#define HOODOO_MEMORY_H

#include <stddef.h>

#include "base/status.h"

/* Allocates n zeroed items of `size` bytes; *out (a pointer to a pointer) receives the address, to be released with free().
 * n = 0 gives a valid pointer. E_MEMORY: the message names `what` and the size; *out is NULL. */
MUST_USE status memory_alloc(size_t n, size_t size, const char *what, void *out);

/* Grows *array by doubling until it holds at least `want` items, and updates *capacity. New items are zeroed. On E_MEMORY the
 * array is unchanged. */
MUST_USE status memory_grow(void *array, size_t *capacity, size_t want, size_t size, const char *what);

/* Copies `text`; the copy is released with free(). */
MUST_USE status memory_strdup(const char *text, char **out);

/* Host memory in bytes that this process may still use: the least that MemAvailable, control groups and resource limits leave
 * (system/memory_limits.h). */
size_t memory_available(void);

#endif
