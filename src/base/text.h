/* A growing text, and JSON written into it.
 *
 * Calling sequence   struct text t = {0}; text_add(&t, ...); ...; if (t.failed) ...; text_free(&t);
 * Error handling     A failed allocation sets t.failed and makes later calls do nothing: check once at the
 *                    end.
 * Ownership          t.data is t's; text_free() releases it, and {0} is a valid empty text.
 */
#ifndef HOODOO_TEXT_H
#define HOODOO_TEXT_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "base/status.h"

struct text {
    char *data; /* NUL-terminated once anything was added */
    size_t size, capacity;
    bool failed;
    /* JSON writer: nesting, and whether the next value needs a comma */
    int depth;
    bool comma;
};

void text_add(struct text *t, const char *format, ...) PRINTF_LIKE(2, 3);
void text_add_bytes(struct text *t, const void *bytes, size_t n);
void text_free(struct text *t);

/* OK, or E_MEMORY if any call failed. */
MUST_USE status text_status(const struct text *t);

/* JSON, one member a line, two spaces a level. `key` is NULL inside arrays. Numbers are the shortest decimals
 * that read back as the same double; text is escaped; non-finite numbers become null. */
/* Words in lines of `width` columns, each begun by `indent` spaces but for the first, which goes on at column `at`; ends the last
 * line. */
void text_add_wrapped(struct text *t, const char *words, int at, int indent, int width);

void json_object(struct text *t, const char *key);
void json_array(struct text *t, const char *key);
void json_end_object(struct text *t);
void json_end_array(struct text *t);
void json_text(struct text *t, const char *key, const char *value);
void json_number(struct text *t, const char *key, double value);
void json_integer(struct text *t, const char *key, int64_t value);
void json_bool(struct text *t, const char *key, bool value);

/* Puts JSON that was written so far on one line, for files and pipes of a document a line. Lines are broken between members only: texts
 * hold none. */
void json_one_line(struct text *t);

/* The shortest "%.*g" form of `value` that reads back exactly, in `out` (at least 32 bytes); returns out. */
const char *number_text(double value, char out[32]);

#endif
