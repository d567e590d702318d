/* JSON (text.h writes it), read strictly: RFC 8259, no duplicate keys, at most 32 levels deep. The bytes may
 * be hostile: time and memory grow no faster than their number (sorting keys aside).
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
    const char *key;  /* NULL but in objects */
    const char *text; /* JSON_TEXT: no NUL in it. JSON_NUMBER: as it was written */
    double number;    /* JSON_NUMBER: may be infinite. JSON_BOOL: 0 or 1 */
    size_t n;         /* JSON_ARRAY, JSON_OBJECT: items */
    struct json *first, *next;
};

/* *out is the whole; all of it is freed with json_free(), and `bytes` may go. E_INPUT names `path` (unless
 * NULL), the line and column, and what is wrong. */
MUST_USE status json_read(const char *path, const char *bytes, size_t n, struct json **out);
void json_free(struct json **json);

/* The member of an object, or NULL: also if `object` is NULL or none. */
const struct json *json_member(const struct json *object, const char *key);

/* False, leaving *out alone, unless `json` is a number without fraction or exponent that fits. */
bool json_to_uint64(const struct json *json, uint64_t *out);
bool json_to_integer(const struct json *json, int64_t min, int64_t max, int64_t *out);
bool json_to_int(const struct json *json, int *out);

/* NULL unless `json` is a text. */
const char *json_to_text(const struct json *json);

#endif
