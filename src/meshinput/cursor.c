#include <errno.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "meshinput/decode.h"

bool attribute_is(struct attribute *a, const char *name)
{
    char quoted[80];
    const size_t n = strlen(a->there);
    snprintf(quoted, sizeof quoted, "'%.70s'", name);
    if (!strstr(a->there, quoted) && n + strlen(quoted) + 3 < sizeof a->there)
        snprintf(a->there + n, sizeof a->there - n, "%s%s", n ? ", " : "", quoted);
    const bool is = *a->name && strcmp(a->name, name) == 0;
    a->found |= is;
    return is;
}

status cursor_fail(const struct cursor *r, const char *format, ...)
{
    char text[512];
    va_list args;
    va_start(args, format);
    vsnprintf(text, sizeof text, format, args);
    va_end(args);
    return fail(E_INPUT, "%s:%zu: %s", r->path, r->line, text);
}

bool cursor_at_line_end(struct cursor *r)
{
    for (; r->at < r->end; r->at++) {
        if (*r->at == '\n')
            return true;
        if (*r->at == '\\' && r->at + 1 < r->end && r->at[1] == '\n') {
            r->at++;
            r->line++;
        } else if (*r->at == '\\' && r->end - r->at > 2 && r->at[1] == '\r' && r->at[2] == '\n') {
            r->at += 2;
            r->line++;
        } else if (*r->at != ' ' && *r->at != '\t' && *r->at != '\r') {
            return false;
        }
    }
    return true;
}

void cursor_next_line(struct cursor *r)
{
    const char *newline = memchr(r->at, '\n', (size_t)(r->end - r->at));
    r->at = newline ? newline + 1 : r->end;
    r->line += newline != NULL;
}

/* The token at the cursor, shortened for a message. */
static const char *token(const struct cursor *r, char out[24])
{
    size_t n = 0;
    while (n < 20 && r->at + n < r->end && r->at[n] > ' ')
        n++;
    memcpy(out, r->at, n);
    strcpy(out + n, n == 20 ? "..." : "");
    return n ? out : "nothing";
}

status cursor_number(struct cursor *r, double *out)
{
    char text[24], *stop;
    if (cursor_at_line_end(r))
        return cursor_fail(r, "a number is missing at the end of the line");
    double value = strtod(r->at, &stop); /* the bytes end in a NUL */
    if (stop == r->at)
        return cursor_fail(r, "expected a number, found '%s'", token(r, text));
    if (!(fabs(value) <= 1e30))
        return cursor_fail(r, "'%s' is not finite or larger than 1e30", token(r, text));
    r->at = stop;
    *out = value;
    return OK;
}

status cursor_integer(struct cursor *r, int64_t *out)
{
    char text[24], *stop;
    if (cursor_at_line_end(r))
        return cursor_fail(r, "an integer is missing at the end of the line");
    errno = 0;
    long long value = strtoll(r->at, &stop, 10);
    if (stop == r->at || errno != 0)
        return cursor_fail(r, "expected an integer, found '%s'", token(r, text));
    r->at = stop;
    *out = value;
    return OK;
}
