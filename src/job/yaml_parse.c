/* Parses bytes into a tree of struct yaml. */
#include <libfyaml.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "job/yaml.h"
#include "text/utf8.h"

struct reading {
    struct yaml_tree *tree;
    const struct yaml_source *source;
    struct yaml *root;
    struct yaml *open[YAML_DEPTH]; /* the collections around the next event */
    int depth;
    const char *key; /* a key whose value is still to be read */
    int key_line, key_column;
    int documents;
};

static status fail_at(const struct yaml_source *source, int line, int column, const char *what)
{
    const struct yaml at = {.source = source, .line = line, .column = column};
    if (source->set)
        return yaml_fail(&at, NULL, "column %d of the value: %s", column, what);
    return yaml_fail(&at, NULL, "%s", what);
}

/* Refuses input that makes libfyaml's scanner fail or take minutes: invalid bytes, and many unclosed brackets. */
static status check_bytes(const char *bytes, size_t n, const struct yaml_source *source)
{
    enum { BRACKETS = 1000 }; /* far above YAML_DEPTH, because comments and texts may contain brackets too */
    int line = 1, column = 1, brackets = 0;
    if (n > YAML_BYTES)
        return fail_at(source, 1, 1, "larger than 4 MiB");
    for (size_t i = 0, length; i < n; i += length) {
        length = utf8_length(bytes + i, n - i);
        if (length == 0)
            return fail_at(source, line, column, "not UTF-8 text");
        if (bytes[i] == '\0')
            return fail_at(source, line, column, "a NUL byte");
        if (bytes[i] == '[' || bytes[i] == '{')
            brackets++;
        if ((bytes[i] == ']' || bytes[i] == '}') && brackets > 0)
            brackets--;
        if (brackets > BRACKETS)
            return fail_at(source, line, column, "nested too deeply");
        column++;
        if (bytes[i] == '\n') {
            line++;
            column = 1;
        }
    }
    return OK;
}

/* Copies a scalar into the tree. */
static status copy_scalar(struct reading *r, struct fy_token *token, int line, int column, const char **out)
{
    size_t n = 0;
    const char *text = token ? fy_token_get_text(token, &n) : "";
    if (!text)
        return fail(E_MEMORY, "out of memory: reading %s", r->source->file);
    if (n > YAML_TEXT)
        return fail_at(r->source, line, column, "a text of more than 4096 bytes");
    if (memchr(text, '\0', n))
        return fail_at(r->source, line, column, "a NUL character in a text");
    for (size_t i = 0, length; i < n; i += length)
        if ((length = utf8_length(text + i, n - i)) == 0)
            return fail_at(r->source, line, column, "an escape that is not a character");
    return yaml_copy(r->tree, text, n, out);
}

static status add_value(struct reading *r, enum yaml_kind kind, int line, int column, struct yaml **out)
{
    struct yaml *parent = r->depth ? r->open[r->depth - 1] : NULL;
    status st = yaml_new(r->tree, kind, r->source, out);
    if (st != OK)
        return st;
    struct yaml *v = *out;
    v->line = line;
    v->column = column;
    if (!parent) {
        r->root = v;
        return OK;
    }
    v->key = r->key;
    v->key_line = r->key_line;
    v->key_column = r->key_column;
    r->key = NULL;
    yaml_append(parent, v);
    if (parent->n > YAML_ITEMS)
        return yaml_fail(parent, NULL, "more than %d items", YAML_ITEMS);
    return OK;
}

static status open_collection(struct reading *r, enum yaml_kind kind, int line, int column)
{
    struct yaml *v = NULL;
    status st = add_value(r, kind, line, column, &v);
    if (st != OK)
        return st;
    if (r->depth == YAML_DEPTH)
        return fail_at(r->source, line, column,
                       "nested too deeply (at most 64 levels of lists and mappings)");
    r->open[r->depth++] = v;
    return OK;
}

static int by_key(const void *a, const void *b)
{
    const struct yaml *x = *(const struct yaml *const *)a, *y = *(const struct yaml *const *)b;
    int order = strcmp(x->key, y->key);
    if (order)
        return order;
    if (x->key_line != y->key_line)
        return x->key_line < y->key_line ? -1 : 1;
    return (x->key_column > y->key_column) - (x->key_column < y->key_column);
}

/* Sorts the keys, because a hostile mapping may have 100000 of them. */
static status close_mapping(const struct yaml *map)
{
    const struct yaml **sorted = NULL;
    status st = memory_alloc(map->n, sizeof *sorted, "a mapping's keys", &sorted);
    if (st != OK)
        return st;
    size_t n = 0;
    for (const struct yaml *v = map->first; v; v = v->next)
        sorted[n++] = v;
    qsort(sorted, n, sizeof *sorted, by_key);
    for (size_t i = 1; i < n && st == OK; i++)
        if (strcmp(sorted[i]->key, sorted[i - 1]->key) == 0)
            st = yaml_fail_key(sorted[i], "given twice (first on line %d)", sorted[i - 1]->key_line);
    free(sorted);
    return st;
}

static status take_scalar(struct reading *r, struct fy_token *token, int line, int column)
{
    struct yaml *parent = r->depth ? r->open[r->depth - 1] : NULL, *v = NULL;
    const char *text;
    status st = copy_scalar(r, token, line, column, &text);
    if (st != OK)
        return st;
    if (parent && parent->kind == YAML_MAP && !r->key) {
        if (strcmp(text, "<<") == 0)
            return fail_at(r->source, line, column, "merge keys (<<) are not allowed: write the keys out");
        r->key = text;
        r->key_line = line;
        r->key_column = column;
        return OK;
    }
    st = add_value(r, YAML_SCALAR, line, column, &v);
    if (st == OK) {
        v->text = text;
        v->quoted = token && fy_token_scalar_style(token) != FYSS_PLAIN;
    }
    return st;
}

static status take(struct reading *r, struct fy_event *e)
{
    const struct fy_mark *mark = fy_event_start_mark(e);
    /* An empty value has no position of its own and gets that of its key. */
    int line = mark ? mark->line + 1 : r->key_line, column = mark ? mark->column + 1 : r->key_column;
    struct fy_token *anchor = NULL, *tag = NULL;
    switch (e->type) {
    case FYET_SCALAR:
        anchor = e->scalar.anchor, tag = e->scalar.tag;
        break;
    case FYET_MAPPING_START:
        anchor = e->mapping_start.anchor, tag = e->mapping_start.tag;
        break;
    case FYET_SEQUENCE_START:
        anchor = e->sequence_start.anchor, tag = e->sequence_start.tag;
        break;
    default:
        break;
    }
    if (e->type == FYET_ALIAS)
        column--; /* libfyaml's position is behind the asterisk */
    if (e->type == FYET_ALIAS || anchor)
        return fail_at(r->source, line, column,
                       "anchors (&) and aliases (*) are not allowed: write the value out");
    if (tag)
        return fail_at(r->source, line, column, "tags (!) are not allowed");
    const struct yaml *parent = r->depth ? r->open[r->depth - 1] : NULL;
    bool collection = e->type == FYET_MAPPING_START || e->type == FYET_SEQUENCE_START;
    if (collection && parent && parent->kind == YAML_MAP && !r->key)
        return fail_at(r->source, line, column, "a list or mapping cannot be a key");
    switch (e->type) {
    case FYET_DOCUMENT_START:
        return ++r->documents > 1 ? fail_at(r->source, line, column, "more than one document") : OK;
    case FYET_SCALAR:
        return take_scalar(r, e->scalar.value, line, column);
    case FYET_MAPPING_START:
        return open_collection(r, YAML_MAP, line, column);
    case FYET_SEQUENCE_START:
        return open_collection(r, YAML_LIST, line, column);
    case FYET_MAPPING_END:
        return close_mapping(r->open[--r->depth]);
    case FYET_SEQUENCE_END:
        r->depth--;
        return OK;
    default:
        return OK;
    }
}

/* The error message of libfyaml, which would otherwise be printed. */
static status syntax_error(struct reading *r, struct fy_diag *diag)
{
    void *position = NULL;
    const struct fy_diag_error *e = fy_diag_errors_iterate(diag, &position);
    char what[256];
    if (!e)
        return fail_at(r->source, 1, 1, "not YAML");
    snprintf(what, sizeof what, "not YAML: %.200s", e->msg);
    return fail_at(r->source, e->line, e->column, what);
}

status yaml_parse(struct yaml_tree *tree, const char *bytes, size_t n, const struct yaml_source *source,
                  struct yaml **root)
{
    struct reading r = {.tree = tree, .source = source};
    struct fy_diag_cfg quiet;
    struct fy_diag *diag = NULL;
    struct fy_parser *parser = NULL;
    bool ended = false;
    status st = OK;
    TRY(check_bytes(bytes, n, source));
    fy_diag_cfg_default(&quiet);
    quiet.fp = NULL;
    quiet.level = FYET_ERROR;
    diag = fy_diag_create(&quiet);
    if (diag) {
        fy_diag_set_collect_errors(diag, true);
        const struct fy_parse_cfg cfg = {.flags = FYPCF_DEFAULT_VERSION_1_2 | FYPCF_JSON_NONE, .diag = diag};
        parser = fy_parser_create(&cfg);
    }
    if (!parser || fy_parser_set_string(parser, bytes, n) != 0) {
        st = fail(E_MEMORY, "out of memory: reading %s", source->file);
        goto done;
    }
    while (st == OK && !ended) {
        struct fy_event *e = fy_parser_parse(parser);
        if (!e)
            break;
        ended = e->type == FYET_STREAM_END;
        st = take(&r, e);
        fy_parser_event_free(parser, e);
    }
    if (st == OK && !ended)
        st = syntax_error(&r, diag);
    if (st == OK && !r.root)
        st = take_scalar(&r, NULL, 1, 1);
    *root = r.root;
done:
    fy_parser_destroy(parser);
    fy_diag_destroy(diag);
    return st;
}
