/* Heap memory that reports failure as a status, and never multiplies past SIZE_MAX. */
#ifndef HOODOO_MEMORY_H
#define HOODOO_MEMORY_H

#include <stddef.h>

#include "base/status.h"

/* n zeroed items of `size` bytes in *out (a pointer to a pointer). E_MEMORY names `what` and the bytes asked
 * for. n = 0 gives a valid pointer. Freed with free(). */
MUST_USE status memory_alloc(size_t n, size_t size, const char *what, void *out);

/* Room for at least `want` items in *array, growing by doubling; *capacity is kept. New items are zeroed. */
MUST_USE status memory_grow(void *array, size_t *capacity, size_t want, size_t size, const char *what);

/* A copy of `text`, freed with free(). */
MUST_USE status memory_strdup(const char *text, char **out);

/* Host memory this process may still use, in bytes: MemAvailable, or the control group's limit if that is
 * lower. */
size_t memory_available(void);

#endif
