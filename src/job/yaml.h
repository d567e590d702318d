/* A YAML document as a tree whose values record their position in the file.
 *
 * libfyaml parses the syntax. Features that jobs do not need and that hostile files exploit are refused: aliases, anchors, tags,
 * keys that are not text, duplicate keys, several documents, NUL bytes, invalid UTF-8, and more nesting, items or bytes than
 * any real job has.
 *
 * Ownership   All values belong to the yaml_tree; yaml_free() releases them together.
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

/* The origin of a text: a file, or a --set (then `set` is its key path, else NULL). */
struct yaml_source {
    const char *file, *set;
};

struct yaml {
    enum yaml_kind kind;
    bool quoted;      /* scalar: in quotes or a block, hence text even if it looks like a number */
    const char *text; /* scalar */
    const char *key;  /* in a mapping */
    const struct yaml_source *source;
    int line, column, key_line, key_column; /* from 1; 0: unknown */
    struct yaml *parent, *next, *first, *last;
    size_t n; /* children */
};

struct yaml_tree {
    struct yaml_block *blocks;
    size_t n_values;
};

/* Parses one document; an empty one is a null scalar. E_USAGE: the message has the position. `source` is borrowed and must outlive the
 * tree. */
MUST_USE status yaml_parse(struct yaml_tree *tree, const char *bytes, size_t n,
                           const struct yaml_source *source, struct yaml **root);
void yaml_free(struct yaml_tree *tree);

/* Allocate zeroed memory, or a copy of a text, that belongs to the tree. */
MUST_USE status yaml_alloc(struct yaml_tree *tree, size_t size, void *out);
MUST_USE status yaml_copy(struct yaml_tree *tree, const char *text, size_t n, const char **out);

/* Creates a value without a parent. E_USAGE if the tree is full. */
MUST_USE status yaml_new(struct yaml_tree *tree, enum yaml_kind kind, const struct yaml_source *source,
                         struct yaml **out);
void yaml_append(struct yaml *parent, struct yaml *child);

/* Child by key or index; NULL if there is none. */
struct yaml *yaml_get(const struct yaml *map, const char *key);
struct yaml *yaml_item(const struct yaml *list, size_t i);

bool yaml_is_null(const struct yaml *value);

/* The kind of a value for messages: "a list", "a number", "an empty value" ... */
const char *yaml_what(const struct yaml *value);

/* E_USAGE: "file:line:column: key.path: MESSAGE", or "--set key.path: MESSAGE". `below` (or NULL) is a key
 * under `at`. */
status yaml_fail(const struct yaml *at, const char *below, const char *format, ...) PRINTF_LIKE(3, 4);

/* The same, at the key of `at` rather than its value. */
status yaml_fail_key(const struct yaml *at, const char *format, ...) PRINTF_LIKE(2, 3);

/* Parses a finite decimal number; refuses hexadecimal numbers, .inf, .nan and 1_000. */
bool yaml_decimal(const char *text, double *out);

#endif
