#include "farm/argv.h"

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"

enum { ARGUMENT_MOST = 131071 }; /* MAX_ARG_STRLEN less its NUL */

void argv_add(struct argv_list *a, const char *format, ...)
{
    va_list list;
    char *text = NULL;
    va_start(list, format);
    const int n = vasprintf(&text, format, list);
    va_end(list);
    if (n < 0 || a->failed ||
        memory_grow(&a->argv, &a->capacity, a->n + 2, sizeof *a->argv, "arguments") != OK) {
        if (n >= 0)
            free(text);
        a->failed = true;
        return;
    }
    a->argv[a->n++] = text;
    a->argv[a->n] = NULL;
}

status argv_status(const struct argv_list *a)
{
    if (a->failed || !a->argv)
        return fail(E_MEMORY, "no memory for the arguments of a command");
    for (size_t i = 0; i < a->n; i++)
        if (strlen(a->argv[i]) > ARGUMENT_MOST)
            return fail(
                E_USAGE,
                "%s: the argument %.40s... has %zu bytes, more than the %d that the kernel takes; use larger farm.block_frames or farm.chunk_frames",
                a->argv[0], a->argv[i], strlen(a->argv[i]), ARGUMENT_MOST);
    return OK;
}

void argv_free(struct argv_list *a)
{
    for (size_t i = 0; i < a->n; i++)
        free(a->argv[i]);
    free(a->argv);
    *a = (struct argv_list){0};
}
