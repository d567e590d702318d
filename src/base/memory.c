#include "base/memory.h"

#include <stdint.h>
#include <stdlib.h>
#include <string.h>

status memory_alloc(size_t n, size_t size, const char *what, void *out)
{
    void *p = NULL;
    if (size == 0 || n <= SIZE_MAX / size)
        p = calloc(n ? n : 1, size ? size : 1);
    memcpy(out, &p, sizeof p);
    if (!p)
        return fail(E_MEMORY, "out of memory: %s needs %zu x %zu bytes", what, n, size);
    return OK;
}

status memory_grow(void *array, size_t *capacity, size_t want, size_t size, const char *what)
{
    void *p;
    memcpy(&p, array, sizeof p);
    if (want <= *capacity)
        return OK;
    size_t grown = *capacity < 16 ? 16 : *capacity;
    while (grown < want) {
        if (grown > SIZE_MAX / 2)
            return fail(E_MEMORY, "out of memory: %s needs %zu x %zu bytes", what, want, size);
        grown *= 2;
    }
    void *q = grown <= SIZE_MAX / size ? realloc(p, grown * size) : NULL;
    if (!q)
        return fail(E_MEMORY, "out of memory: %s needs %zu x %zu bytes", what, grown, size);
    memset((char *)q + *capacity * size, 0, (grown - *capacity) * size);
    memcpy(array, &q, sizeof q);
    *capacity = grown;
    return OK;
}

status memory_strdup(const char *text, char **out)
{
    size_t n = strlen(text) + 1;
    status st = memory_alloc(n, 1, "a text", out);
    if (st == OK)
        memcpy(*out, text, n);
    return st;
}
