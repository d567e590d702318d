/* Strict JSON (RFC 8259) into a flat table, for files that may be hostile.
 *
 * Calling sequence   struct json_doc j = {0}; TRY(json_parse(text, size, &j)); ...; json_doc_free(&j);
 * Ownership          `text` is only read, and must outlive j. Values point into the table.
 * Limits             nesting JSON_DEPTH; memory is at most a fixed multiple of the text's size.
 */
#ifndef HOODOO_JSON_READ_H
#define HOODOO_JSON_READ_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "base/status.h"

enum { JSON_DEPTH = 32 };
enum json_type {
    JSON_IS_NULL,
    JSON_IS_FALSE,
    JSON_IS_TRUE,
    JSON_IS_NUMBER,
    JSON_IS_TEXT,
    JSON_IS_ARRAY,
    JSON_IS_OBJECT
};

struct json_value {
    enum json_type kind;
    uint32_t key, key_size; /* in the text, without quotes, as escaped there; members of objects only */
    uint32_t at, size;      /* texts: without quotes */
    uint32_t n;             /* arrays and objects: how many values they hold */
    uint32_t after;         /* index of the first value behind this one and what it holds */
};

struct json_doc {
    const char *text;
    struct json_value *value; /* value[0] is the whole; a group's values follow it */
    size_t n, capacity;
};

/* E_INPUT with line and column. */
MUST_USE status json_parse(const char *text, size_t size, struct json_doc *out);
void json_doc_free(struct json_doc *j);

/* The first value in an array or object, and the one after `v` there. The caller counts (group->n). */
const struct json_value *json_first(const struct json_value *group);
const struct json_value *json_next(const struct json_doc *j, const struct json_value *v);

/* The member of that name; NULL if there is none, or `object` is NULL or no object. */
const struct json_value *json_find(const struct json_doc *j, const struct json_value *object,
                                   const char *key);

/* False if `v` is NULL, of another kind, or does not fit. Texts come with escapes undone; U+0000 never fits.
 */
bool json_get_text(const struct json_doc *j, const struct json_value *v, char *out, size_t size);
bool json_get_key(const struct json_doc *j, const struct json_value *v, char *out, size_t size);
bool json_get_integer(const struct json_doc *j, const struct json_value *v, int64_t min, int64_t max,
                      int64_t *out);
bool json_get_number(const struct json_doc *j, const struct json_value *v, double *out);

#endif
