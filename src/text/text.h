/* A growing text buffer, and a JSON writer on top of it.
 *
 * Calling sequence   struct text t = {0}; text_add(&t, ...); ...; TRY(text_status(&t)); text_free(&t);
 * Errors             A failed allocation sets t.failed, and further calls have no effect: check once at the end.
 * Ownership          The buffer owns t.data; text_free() releases it. {0} is an empty text.
 */
#ifndef HOODOO_TEXT_H
#define HOODOO_TEXT_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "base/status.h"

struct text {
    char *data; /* NUL-terminated; NULL until something is added */
    size_t size, capacity;
    bool failed;
    /* JSON writer: nesting depth, and whether a comma precedes the next value */
    int depth;
    bool comma;
};

void text_add(struct text *t, const char *format, ...) PRINTF_LIKE(2, 3);
void text_add_bytes(struct text *t, const void *bytes, size_t n);
void text_free(struct text *t);

/* E_MEMORY if any call failed, else OK. */
MUST_USE status text_status(const struct text *t);

/* Adds `words` wrapped to `width` columns and ends the last line. The first line continues at column `at`; further lines are
 * indented by `indent` spaces. */
void text_add_wrapped(struct text *t, const char *words, int at, int indent, int width);

/* JSON, one member per line, indented by two spaces per level. `key` is NULL inside arrays. Numbers are written as the shortest
 * decimals that read back as the same double, and as null if not finite; texts are escaped. */
void json_object(struct text *t, const char *key);
void json_array(struct text *t, const char *key);
void json_end_object(struct text *t);
void json_end_array(struct text *t);
void json_text(struct text *t, const char *key, const char *value);
void json_number(struct text *t, const char *key, double value);
void json_integer(struct text *t, const char *key, int64_t value);
void json_bool(struct text *t, const char *key, bool value);

/* Puts the JSON written so far on one line, for files and pipes with one document per line. */
void json_one_line(struct text *t);

/* The shortest "%.*g" form of `value` that reads back exactly; returns out. */
const char *number_text(double value, char out[32]);

#endif
