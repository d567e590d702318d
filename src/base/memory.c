#include "base/memory.h"

#include <stdint.h>
#include <stdio.h>
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

static size_t read_number(const char *path, const char *key)
{
    FILE *f = fopen(path, "r");
    char line[256];
    size_t value = SIZE_MAX;
    while (f && fgets(line, sizeof line, f)) {
        size_t skip = key ? strlen(key) : 0;
        unsigned long long number;
        if ((!key || strncmp(line, key, skip) == 0) && sscanf(line + skip, "%llu", &number) == 1) {
            value = (size_t)number;
            break;
        }
    }
    if (f)
        fclose(f);
    return value;
}

size_t memory_available(void)
{
    size_t kib = read_number("/proc/meminfo", "MemAvailable:");
    size_t available = kib > SIZE_MAX / 1024 ? SIZE_MAX : kib * 1024;
    size_t limit = read_number("/sys/fs/cgroup/memory.max", NULL);
    size_t used = read_number("/sys/fs/cgroup/memory.current", NULL);
    if (limit != SIZE_MAX && used != SIZE_MAX) {
        size_t left = limit > used ? limit - used : 0;
        if (left < available)
            available = left;
    }
    return available;
}
