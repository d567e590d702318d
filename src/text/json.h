/* A strict JSON parser (text.h has the writer): RFC 8259, without duplicate keys, nested at most 32 levels deep. The input may
 * be hostile: memory is linear in its size, and time is too except for sorting keys.
 *
 * Calling sequence   struct json *json; TRY(json_read(path, bytes, n, &json)); ...; json_free(&json);
 */
#ifndef HOODOO_JSON_H
#define HOODOO_JSON_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "base/status.h"

enum json_kind { JSON_NULL, JSON_BOOL, JSON_NUMBER, JSON_TEXT, JSON_ARRAY, JSON_OBJECT };

struct json {
    enum json_kind kind;
    const char *key;  /* member of an object: its key; else NULL */
    const char *text; /* JSON_TEXT: the text, which contains no NUL. JSON_NUMBER: the number as written */
    double number;    /* JSON_NUMBER: infinite if it overflows. JSON_BOOL: 0 or 1 */
    size_t n;         /* JSON_ARRAY, JSON_OBJECT: number of items */
    struct json *first, *next;
};

/* Parses one document. *out is its root; json_free() releases the whole tree, which keeps no reference to `bytes`. E_INPUT: the
 * message has `path` (unless NULL), line, column and what is wrong. */
MUST_USE status json_read(const char *path, const char *bytes, size_t n, struct json **out);
void json_free(struct json **json);

/* The member of an object by key, or NULL if there is none, `object` is NULL or it is not an object. */
const struct json *json_member(const struct json *object, const char *key);

/* Return false and leave *out unchanged unless `json` is a number without fraction or exponent within the range. */
bool json_to_uint64(const struct json *json, uint64_t *out);
bool json_to_integer(const struct json *json, int64_t min, int64_t max, int64_t *out);
bool json_to_int(const struct json *json, int *out);

/* The text, or NULL if `json` is not a text. */
const char *json_to_text(const struct json *json);

#endif
