/* A YAML document as a plain tree in which every value knows where it stands.
 *
 * libfyaml does the syntax; this refuses what a job has no use for and hostile files live on: aliases,
 * anchors, tags, keys that are not text, duplicate keys, several documents, NUL bytes, invalid UTF-8, and
 * more nesting, items or bytes than any real job has.
 *
 * Ownership   Everything belongs to the yaml_tree; yaml_free() releases it at once.
 */
#ifndef HOODOO_JOB_YAML_H
#define HOODOO_JOB_YAML_H

#include <stdbool.h>
#include <stddef.h>

#include "base/status.h"

enum {
    YAML_BYTES = 4 << 20,  /* in a file */
    YAML_DEPTH = 64,       /* collections inside each other */
    YAML_ITEMS = 100000,   /* in one list or mapping */
    YAML_VALUES = 1000000, /* in a tree */
    YAML_TEXT = 4096       /* bytes of a scalar or key */
};

enum yaml_kind { YAML_SCALAR, YAML_LIST, YAML_MAP };

/* Where text comes from: a file, or the key path of a --set (then `set` is not NULL). */
struct yaml_source {
    const char *file, *set;
};

struct yaml {
    enum yaml_kind kind;
    bool quoted;      /* scalar: in quotes or a block, so text whatever it looks like */
    const char *text; /* scalar */
    const char *key;  /* in a mapping */
    const struct yaml_source *source;
    int line, column, key_line, key_column; /* from 1; 0 unknown */
    struct yaml *parent, *next, *first, *last;
    size_t n; /* children */
};

struct yaml_tree {
    struct yaml_block *blocks;
    size_t n_values;
};

/* One document. An empty one is a null scalar. E_USAGE names the place. `source` is borrowed for the tree's
 * life. */
MUST_USE status yaml_parse(struct yaml_tree *tree, const char *bytes, size_t n,
                           const struct yaml_source *source, struct yaml **root);
void yaml_free(struct yaml_tree *tree);

/* Zeroed memory of the tree; text copied into it. */
MUST_USE status yaml_alloc(struct yaml_tree *tree, size_t size, void *out);
MUST_USE status yaml_copy(struct yaml_tree *tree, const char *text, size_t n, const char **out);

/* A new value without parent. E_USAGE if the tree is full. */
MUST_USE status yaml_new(struct yaml_tree *tree, enum yaml_kind kind, const struct yaml_source *source,
                         struct yaml **out);
void yaml_append(struct yaml *parent, struct yaml *child);

/* Child by key or index; NULL if there is none. */
struct yaml *yaml_get(const struct yaml *map, const char *key);
struct yaml *yaml_item(const struct yaml *list, size_t i);

bool yaml_is_null(const struct yaml *value);

/* "a list", "a number", "an empty value"..., for messages. */
const char *yaml_what(const struct yaml *value);

/* E_USAGE: "file:line:column: key.path: MESSAGE", or "--set key.path: MESSAGE". `below` (or NULL) is a key
 * under `at`. */
status yaml_fail(const struct yaml *at, const char *below, const char *format, ...) PRINTF_LIKE(3, 4);

/* The same, at the key of `at` rather than its value. */
status yaml_fail_key(const struct yaml *at, const char *format, ...) PRINTF_LIKE(2, 3);

/* A YAML decimal number that is finite: not hexadecimal, .inf, .nan or 1_000. */
bool yaml_decimal(const char *text, double *out);

#endif
