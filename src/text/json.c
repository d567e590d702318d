#include "text/json.h"

#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "text/json_text.h"

enum { DEEPEST = 32 };

/* Nodes and texts are allocated from blocks that are freed together. */
struct block {
    struct block *older;
    size_t used, size;
    _Alignas(max_align_t) char bytes[];
};

struct document {
    struct json root; /* must be first: json_free() is passed its address */
    struct block *blocks;
};

struct reader {
    const char *path, *begin, *at, *end;
    struct document *document;
    int depth;
};

static status syntax_error(const struct reader *r, const char *what)
{
    size_t line = 1, column = 1;
    for (const char *c = r->begin; c < r->at; c++) {
        column = *c == '\n' ? 1 : column + 1;
        line += *c == '\n';
    }
    return fail(E_INPUT, "%s%sline %zu, column %zu: %s", r->path ? r->path : "",
                r->path ? ": not JSON: " : "", line, column, what);
}

static const char *name(const struct reader *r)
{
    return r->path ? r->path : "a JSON text";
}

static status allocate(struct reader *r, size_t n, void *out)
{
    struct block *b = r->document->blocks;
    n = (n + sizeof(max_align_t) - 1) / sizeof(max_align_t) * sizeof(max_align_t);
    if (!b || b->size - b->used < n) {
        const size_t size = n > 16384 ? n : 16384;
        status st = memory_alloc(sizeof *b + size, 1, name(r), &b);
        if (st != OK)
            return st;
        *b = (struct block){.older = r->document->blocks, .size = size};
        r->document->blocks = b;
    }
    void *p = b->bytes + b->used;
    b->used += n;
    memcpy(out, &p, sizeof p);
    return OK;
}

static void skip_space(struct reader *r)
{
    while (r->at < r->end && *r->at && strchr(" \t\r\n", *r->at))
        r->at++;
}

static bool skip(struct reader *r, const char *word)
{
    const size_t n = strlen(word);
    if ((size_t)(r->end - r->at) < n || memcmp(r->at, word, n) != 0)
        return false;
    r->at += n;
    return true;
}

static status read_text(struct reader *r, const char **out)
{
    char *text = NULL;
    const char *end = r->at + 1;
    if (!skip(r, "\""))
        return syntax_error(r, "expected a key in quotes");
    while (end < r->end && *end != '"')
        end += *end == '\\' && r->end - end > 1 ? 2 : 1;
    if (end >= r->end)
        return syntax_error(r, "unterminated text");
    status st = allocate(r, (size_t)(end - r->at) + 1, &text);
    if (st != OK)
        return st;
    const char *bad = json_unescape(&r->at, end, text);
    if (bad)
        return syntax_error(r, bad);
    r->at = end + 1;
    *out = text;
    return OK;
}

static size_t skip_digits(struct reader *r)
{
    const char *start = r->at;
    while (r->at < r->end && *r->at >= '0' && *r->at <= '9')
        r->at++;
    return (size_t)(r->at - start);
}

static status read_number(struct reader *r, struct json *json)
{
    const char *start = r->at;
    char *text = NULL;
    skip(r, "-");
    bool good = skip(r, "0") || skip_digits(r) > 0;
    if (good && skip(r, "."))
        good = skip_digits(r) > 0;
    if (good && (skip(r, "e") || skip(r, "E"))) {
        if (!skip(r, "-"))
            skip(r, "+");
        good = skip_digits(r) > 0;
    }
    if (!good)
        return syntax_error(r, "invalid number");
    const size_t n = (size_t)(r->at - start);
    status st = allocate(r, n + 1, &text);
    if (st != OK)
        return st;
    memcpy(text, start, n);
    text[n] = '\0';
    json->kind = JSON_NUMBER;
    json->text = text;
    json->number = strtod(text, NULL);
    return OK;
}

static status read_value(struct reader *r, struct json *json);

static int by_key(const void *a, const void *b)
{
    return strcmp((*(const struct json *const *)a)->key, (*(const struct json *const *)b)->key);
}

/* Sorts the keys, because an object of a hostile file may have millions of members. */
static status refuse_duplicates(const struct reader *r, const struct json *object)
{
    status st = OK;
    const struct json **item = NULL;
    size_t n = 0;
    if (object->n < 2)
        return OK;
    TRY(memory_alloc(object->n, sizeof *item, name(r), &item));
    for (const struct json *i = object->first; i; i = i->next)
        item[n++] = i;
    qsort(item, n, sizeof *item, by_key);
    for (size_t i = 1; i < n && st == OK; i++)
        if (by_key(&item[i - 1], &item[i]) == 0)
            st = syntax_error(r, "duplicate key in the object that ends here");
done:
    free(item);
    return st;
}

static status read_key(struct reader *r, struct json *item)
{
    status st = read_text(r, &item->key);
    if (st != OK)
        return st;
    skip_space(r);
    return skip(r, ":") ? OK : syntax_error(r, "expected ':'");
}

static status read_items(struct reader *r, struct json *json, enum json_kind kind)
{
    status st = OK;
    const char *close = kind == JSON_OBJECT ? "}" : "]";
    struct json **link = &json->first;
    json->kind = kind;
    if (++r->depth > DEEPEST)
        return syntax_error(r, "nested too deeply");
    skip_space(r);
    if (skip(r, close))
        goto done;
    do {
        struct json *item = NULL;
        TRY(allocate(r, sizeof *item, &item));
        *item = (struct json){0};
        skip_space(r);
        if (kind == JSON_OBJECT)
            TRY(read_key(r, item));
        TRY(read_value(r, item));
        *link = item;
        link = &item->next;
        json->n++;
        skip_space(r);
    } while (skip(r, ","));
    if (!skip(r, close))
        return syntax_error(r, kind == JSON_OBJECT ? "expected ',' or '}'" : "expected ',' or ']'");
    if (kind == JSON_OBJECT)
        TRY(refuse_duplicates(r, json));
done:
    r->depth--;
    return st;
}

static status read_value(struct reader *r, struct json *json)
{
    skip_space(r);
    if (skip(r, "{"))
        return read_items(r, json, JSON_OBJECT);
    if (skip(r, "["))
        return read_items(r, json, JSON_ARRAY);
    if (r->at < r->end && *r->at == '"') {
        json->kind = JSON_TEXT;
        return read_text(r, &json->text);
    }
    if (skip(r, "null"))
        return OK;
    json->kind = JSON_BOOL;
    json->number = 1;
    if (skip(r, "true"))
        return OK;
    json->number = 0;
    if (skip(r, "false"))
        return OK;
    if (r->at == r->end)
        return syntax_error(r, "unexpected end");
    if (!strchr("-0123456789", *r->at) || !*r->at)
        return syntax_error(r, "expected a value");
    return read_number(r, json);
}

status json_read(const char *path, const char *bytes, size_t n, struct json **out)
{
    status st = OK;
    struct document *document = NULL;
    struct reader r = {.path = path, .begin = bytes, .at = bytes, .end = bytes + n};
    TRY(memory_alloc(1, sizeof *document, name(&r), &document));
    r.document = document;
    TRY(read_value(&r, &document->root));
    skip_space(&r);
    if (r.at != r.end) {
        st = syntax_error(&r, "unexpected text after the end of the document");
        goto done;
    }
    *out = &document->root;
    document = NULL;
done:
    if (document) {
        struct json *root = &document->root;
        json_free(&root);
    }
    return st;
}

void json_free(struct json **json)
{
    struct document *document = (struct document *)(void *)*json;
    while (document && document->blocks) {
        struct block *older = document->blocks->older;
        free(document->blocks);
        document->blocks = older;
    }
    free(document);
    *json = NULL;
}
