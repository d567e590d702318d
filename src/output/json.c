#include "output/json.h"

#include <errno.h>
#include <limits.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"

enum { DEEPEST = 32, MOST_MEMBERS = 4096 };

/* Nodes and texts come from blocks that live and die together; the first block starts with the root. */
struct block {
    struct block *older;
    size_t used, size;
    _Alignas(max_align_t) char bytes[];
};

struct document {
    struct json root; /* first: what json_free() is given */
    struct block *blocks;
};

struct reader {
    const char *path, *at, *end;
    struct document *document;
    int line, depth;
};

static status wrong(const struct reader *r, const char *what)
{
    return fail(E_INPUT, "%s:%d: not the JSON hoodoo writes: %s", r->path, r->line, what);
}

static status take(struct reader *r, size_t n, void *out)
{
    struct block *b = r->document->blocks;
    n = (n + sizeof(max_align_t) - 1) / sizeof(max_align_t) * sizeof(max_align_t);
    if (!b || b->size - b->used < n) {
        const size_t size = n > 16384 ? n : 16384;
        status st = memory_alloc(sizeof *b + size, 1, r->path, &b);
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
    for (; r->at < r->end && strchr(" \t\r\n", *r->at) && *r->at; r->at++)
        r->line += *r->at == '\n';
}

static bool skip(struct reader *r, const char *word)
{
    const size_t n = strlen(word);
    if ((size_t)(r->end - r->at) < n || memcmp(r->at, word, n) != 0)
        return false;
    r->at += n;
    return true;
}

static bool read_hex(struct reader *r, unsigned *out)
{
    *out = 0;
    if (r->end - r->at < 4)
        return false;
    for (int i = 0; i < 4; i++) {
        const char c = *r->at++;
        const int digit = c >= '0' && c <= '9'   ? c - '0'
                          : c >= 'a' && c <= 'f' ? c - 'a' + 10
                          : c >= 'A' && c <= 'F' ? c - 'A' + 10
                                                 : -1;
        if (digit < 0)
            return false;
        *out = *out << 4 | (unsigned)digit;
    }
    return true;
}

static char *put_utf8(char *to, unsigned c)
{
    if (c < 0x80) {
        *to++ = (char)c;
        return to;
    }
    const int tail = c < 0x800 ? 1 : c < 0x10000 ? 2 : 3;
    *to++ = (char)((0xf0U << (3 - tail) & 0xff) | c >> 6 * tail);
    for (int i = tail - 1; i >= 0; i--)
        *to++ = (char)(0x80 | (c >> 6 * i & 0x3f));
    return to;
}

static status read_escape(struct reader *r, char **to)
{
    static const char from[] = "\"\\/bfnrt", as[] = "\"\\/\b\f\n\r\t";
    unsigned c, low;
    const char *known = r->at < r->end && *r->at ? strchr(from, *r->at) : NULL;
    if (known) {
        *(*to)++ = as[known - from];
        r->at++;
        return OK;
    }
    if (!skip(r, "u") || !read_hex(r, &c))
        return wrong(r, "a bad escape in a text");
    if (c >= 0xd800 && c < 0xdc00) {
        if (!skip(r, "\\u") || !read_hex(r, &low) || low < 0xdc00 || low > 0xdfff)
            return wrong(r, "half a character in a text");
        c = 0x10000 + ((c & 0x3ff) << 10 | (low & 0x3ff));
    } else if (c == 0 || (c >= 0xdc00 && c < 0xe000)) {
        return wrong(r, "a bad character in a text");
    }
    *to = put_utf8(*to, c);
    return OK;
}

static status read_text(struct reader *r, const char **out)
{
    status st = OK;
    char *text = NULL, *to;
    const char *end = r->at + 1;
    if (!skip(r, "\""))
        return wrong(r, "a text was expected");
    while (end < r->end && *end != '"')
        end += *end == '\\' && r->end - end > 1 ? 2 : 1;
    if (end >= r->end)
        return wrong(r, "a text does not end");
    TRY(take(r, (size_t)(end - r->at) + 1, &text));
    to = text;
    while (r->at < end) {
        if ((unsigned char)*r->at < 0x20) {
            st = wrong(r, "a control character in a text");
            goto done;
        }
        if (*r->at == '\\') {
            r->at++;
            TRY(read_escape(r, &to));
        } else {
            *to++ = *r->at++;
        }
    }
    *to = '\0';
    r->at = end + 1;
    *out = text;
done:
    return st;
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
        return wrong(r, "a bad number");
    const size_t n = (size_t)(r->at - start);
    status st = take(r, n + 1, &text);
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

static status read_items(struct reader *r, struct json *json, enum json_kind kind)
{
    status st = OK;
    const char *close = kind == JSON_OBJECT ? "}" : "]";
    struct json **link = &json->first;
    json->kind = kind;
    if (++r->depth > DEEPEST)
        return wrong(r, "too many levels");
    skip_space(r);
    if (skip(r, close))
        goto done;
    do {
        struct json *item = NULL;
        TRY(take(r, sizeof *item, &item));
        *item = (struct json){0};
        skip_space(r);
        if (kind == JSON_OBJECT) {
            TRY(read_text(r, &item->key));
            if (json_member(json, item->key) || json->n >= MOST_MEMBERS) {
                st = wrong(r, "a key stands twice, or there are too many");
                goto done;
            }
            skip_space(r);
            if (!skip(r, ":")) {
                st = wrong(r, "a ':' was expected");
                goto done;
            }
        }
        TRY(read_value(r, item));
        *link = item;
        link = &item->next;
        json->n++;
        skip_space(r);
    } while (skip(r, ","));
    if (!skip(r, close))
        st = wrong(r, kind == JSON_OBJECT ? "a ',' or '}' was expected" : "a ',' or ']' was expected");
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
    return read_number(r, json);
}

status json_read(const char *path, const char *bytes, size_t n, struct json **out)
{
    status st = OK;
    struct document *document = NULL;
    struct reader r = {.path = path, .at = bytes, .end = bytes + n, .line = 1};
    TRY(memory_alloc(1, sizeof *document, path, &document));
    r.document = document;
    TRY(read_value(&r, &document->root));
    skip_space(&r);
    if (r.at != r.end) {
        st = wrong(&r, "something follows after the end");
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

const struct json *json_member(const struct json *object, const char *key)
{
    if (!object || object->kind != JSON_OBJECT)
        return NULL;
    for (const struct json *item = object->first; item; item = item->next)
        if (strcmp(item->key, key) == 0)
            return item;
    return NULL;
}

bool json_to_uint64(const struct json *json, uint64_t *out)
{
    if (!json || json->kind != JSON_NUMBER || strspn(json->text, "0123456789") != strlen(json->text))
        return false;
    errno = 0;
    const unsigned long long value = strtoull(json->text, NULL, 10);
    if (errno != 0)
        return false;
    *out = value;
    return true;
}

bool json_to_int(const struct json *json, int *out)
{
    if (!json || json->kind != JSON_NUMBER || strpbrk(json->text, ".eE") || json->number < INT_MIN ||
        json->number > INT_MAX)
        return false;
    *out = (int)json->number;
    return true;
}

const char *json_to_text(const struct json *json)
{
    return json && json->kind == JSON_TEXT ? json->text : NULL;
}
