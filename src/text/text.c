#include "text/text.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"

void text_add_bytes(struct text *t, const void *bytes, size_t n)
{
    if (t->failed || memory_grow(&t->data, &t->capacity, t->size + n + 1, 1, "a text") != OK) {
        t->failed = true;
        return;
    }
    if (n)
        memcpy(t->data + t->size, bytes, n);
    t->size += n;
    t->data[t->size] = '\0';
}

void text_add(struct text *t, const char *format, ...)
{
    va_list args, again;
    va_start(args, format);
    va_copy(again, args);
    int n = vsnprintf(NULL, 0, format, args);
    va_end(args);
    if (n < 0 || t->failed ||
        memory_grow(&t->data, &t->capacity, t->size + (size_t)n + 1, 1, "a text") != OK) {
        t->failed = true;
    } else {
        vsnprintf(t->data + t->size, (size_t)n + 1, format, again);
        t->size += (size_t)n;
    }
    va_end(again);
}

void text_free(struct text *t)
{
    free(t->data);
    *t = (struct text){0};
}

status text_status(const struct text *t)
{
    return t->failed ? fail(E_MEMORY, "out of memory while writing text") : OK;
}

const char *number_text(double value, char out[32])
{
    int low = 1, high = 17, exponent;
    /* A decimal that reads back exactly also does so with more digits, hence the binary search for the number of digits.
     * Powers of two are searched linearly: their lower neighbour is closer than their upper one, so that a closer decimal
     * below may fail where a more distant one above succeeds. */
    const bool power = fabs(frexp(value, &exponent)) == 0.5;
    while (low < high) {
        const int digits = power ? low : (low + high) / 2;
        snprintf(out, 32, "%.*g", digits, value);
        if (strtod(out, NULL) == value)
            high = digits;
        else
            low = digits + 1;
    }
    snprintf(out, 32, "%.*g", low, value);
    return out;
}

static void quote(struct text *t, const char *s)
{
    text_add_bytes(t, "\"", 1);
    for (; *s; s++) {
        unsigned char c = (unsigned char)*s;
        if (c == '"' || c == '\\')
            text_add(t, "\\%c", c);
        else if (c < 0x20 || c == 0x7f)
            text_add(t, "\\u%04x", c);
        else
            text_add_bytes(t, s, 1);
    }
    text_add_bytes(t, "\"", 1);
}

static void member(struct text *t, const char *key)
{
    if (t->comma)
        text_add_bytes(t, ",", 1);
    if (t->depth > 0)
        text_add(t, "\n%*s", 2 * t->depth, "");
    if (key) {
        quote(t, key);
        text_add_bytes(t, ": ", 2);
    }
    t->comma = true;
}

static void open_group(struct text *t, const char *key, const char *bracket)
{
    member(t, key);
    text_add_bytes(t, bracket, 1);
    t->depth++;
    t->comma = false;
}

static void close_group(struct text *t, const char *bracket)
{
    t->depth--;
    if (t->comma)
        text_add(t, "\n%*s", 2 * t->depth, "");
    text_add_bytes(t, bracket, 1);
    t->comma = true;
    if (t->depth == 0)
        text_add_bytes(t, "\n", 1);
}

void json_object(struct text *t, const char *key)
{
    open_group(t, key, "{");
}

void json_array(struct text *t, const char *key)
{
    open_group(t, key, "[");
}

void json_end_object(struct text *t)
{
    close_group(t, "}");
}

void json_end_array(struct text *t)
{
    close_group(t, "]");
}

void json_one_line(struct text *t)
{
    /* Texts are escaped, so newlines occur only between members. */
    for (size_t i = 0; i + 1 < t->size; i++)
        if (t->data[i] == '\n')
            t->data[i] = ' ';
}

void json_text(struct text *t, const char *key, const char *value)
{
    member(t, key);
    quote(t, value);
}

void json_number(struct text *t, const char *key, double value)
{
    char number[32];
    member(t, key);
    text_add(t, "%s", isfinite(value) ? number_text(value, number) : "null");
}

void json_integer(struct text *t, const char *key, int64_t value)
{
    member(t, key);
    text_add(t, "%lld", (long long)value);
}

void json_bool(struct text *t, const char *key, bool value)
{
    member(t, key);
    text_add(t, "%s", value ? "true" : "false");
}

void text_add_wrapped(struct text *t, const char *words, int at, int indent, int width)
{
    bool begun = at > 0; /* the current line is not empty */
    while (*words) {
        const int n = (int)strcspn(words, " \n");
        if (n > 0 && begun && at + 1 + n > width) {
            text_add(t, "\n");
            begun = false;
        }
        if (n > 0) {
            text_add(t, "%*s%.*s", begun ? 1 : indent, "", n, words);
            at = (begun ? at + 1 : indent) + n;
            begun = true;
        }
        words += n + (words[n] != 0);
    }
    text_add(t, "\n");
}
