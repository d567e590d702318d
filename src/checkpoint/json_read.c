#include "checkpoint/json_read.h"

#include <stdlib.h>
#include <string.h>

#include "base/memory.h"

struct parser {
    struct json_doc *j;
    size_t at, size;
};

static int peek(const struct parser *p)
{
    return p->at < p->size ? (unsigned char)p->j->text[p->at] : -1;
}

static void skip_space(struct parser *p)
{
    for (int c = peek(p); c == ' ' || c == '\t' || c == '\n' || c == '\r'; c = peek(p))
        p->at++;
}

static status wrong(const struct parser *p, const char *what)
{
    size_t line = 1, column = 1;
    for (size_t i = 0; i < p->at; i++) {
        column = p->j->text[i] == '\n' ? 1 : column + 1;
        line += p->j->text[i] == '\n';
    }
    return fail(E_INPUT, "line %zu, column %zu: %s", line, column, what);
}

static bool is_digit(int c)
{
    return c >= '0' && c <= '9';
}

static bool is_hex_digit(int c)
{
    return is_digit(c) || (c >= 'a' && c <= 'f') || (c >= 'A' && c <= 'F');
}

/* Past a text's closing quote; *at and *size are what stands between the quotes. */
static status text(struct parser *p, uint32_t *at, uint32_t *size)
{
    size_t begin = ++p->at;
    for (; peek(p) != '"'; p->at++) {
        if (peek(p) < 0x20)
            return wrong(p, peek(p) < 0 ? "a text does not end" : "a control character in a text");
        if (peek(p) != '\\')
            continue;
        p->at++;
        if (peek(p) == 'u') {
            for (int i = 0; i < 4; i++) {
                p->at++;
                if (!is_hex_digit(peek(p)))
                    return wrong(p, "\\u needs four hex digits");
            }
        } else if (peek(p) <= 0 || !strchr("\"\\/bfnrt", peek(p))) {
            return wrong(p, "an unknown escape");
        }
    }
    *at = (uint32_t)begin;
    *size = (uint32_t)(p->at++ - begin);
    return OK;
}

static status digits(struct parser *p)
{
    if (!is_digit(peek(p)))
        return wrong(p, "a digit is missing");
    while (is_digit(peek(p)))
        p->at++;
    return OK;
}

static status number(struct parser *p)
{
    status st = OK;
    p->at += peek(p) == '-';
    if (peek(p) == '0')
        p->at++;
    else
        TRY(digits(p));
    if (peek(p) == '.') {
        p->at++;
        TRY(digits(p));
    }
    if (peek(p) == 'e' || peek(p) == 'E') {
        p->at++;
        p->at += peek(p) == '+' || peek(p) == '-';
        TRY(digits(p));
    }
done:
    return st;
}

static bool word(struct parser *p, const char *w)
{
    size_t n = strlen(w);
    if (p->size - p->at < n || memcmp(p->j->text + p->at, w, n) != 0)
        return false;
    p->at += n;
    return true;
}

static status value(struct parser *p, struct json_value v, int depth);

/* The values of an array or object, to its closing bracket. Their number in *n. */
static status group(struct parser *p, bool object, uint32_t *n, int depth)
{
    status st = OK;
    int close = object ? '}' : ']';
    p->at++;
    skip_space(p);
    if (peek(p) == close) {
        p->at++;
        return OK;
    }
    for (;;) {
        struct json_value v = {0};
        skip_space(p);
        if (object) {
            if (peek(p) != '"')
                return wrong(p, "a key in quotes is missing");
            TRY(text(p, &v.key, &v.key_size));
            skip_space(p);
            if (peek(p) != ':')
                return wrong(p, "':' is missing");
            p->at++;
        }
        TRY(value(p, v, depth + 1));
        ++*n;
        skip_space(p);
        int c = peek(p);
        if (c != close && c != ',')
            return wrong(p, object ? "',' or '}' is missing" : "',' or ']' is missing");
        p->at++;
        if (c == close)
            break;
    }
done:
    return st;
}

/* One value, with the key already in `v`. */
static status value(struct parser *p, struct json_value v, int depth)
{
    status st = OK;
    struct json_doc *j = p->j;
    size_t i = j->n;
    if (depth > JSON_DEPTH)
        return wrong(p, "nested too deeply");
    TRY(memory_grow(&j->value, &j->capacity, i + 1, sizeof v, "a JSON file"));
    j->n++;
    skip_space(p);
    size_t begin = p->at;
    int c = peek(p);
    if (c == '{' || c == '[') {
        v.kind = c == '{' ? JSON_IS_OBJECT : JSON_IS_ARRAY;
        TRY(group(p, c == '{', &v.n, depth));
    } else if (c == '"') {
        v.kind = JSON_IS_TEXT;
        TRY(text(p, &v.at, &v.size));
    } else if (c == '-' || is_digit(c)) {
        v.kind = JSON_IS_NUMBER;
        TRY(number(p));
    } else if (word(p, "null")) {
        v.kind = JSON_IS_NULL;
    } else if (word(p, "true")) {
        v.kind = JSON_IS_TRUE;
    } else if (word(p, "false")) {
        v.kind = JSON_IS_FALSE;
    } else {
        return wrong(p, c < 0 ? "it ends too early" : "neither a value nor an end");
    }
    if (v.kind != JSON_IS_TEXT) {
        v.at = (uint32_t)begin;
        v.size = (uint32_t)(p->at - begin);
    }
    v.after = (uint32_t)j->n;
    j->value[i] = v;
done:
    return st;
}

status json_parse(const char *bytes, size_t size, struct json_doc *out)
{
    struct parser p = {.j = out, .size = size};
    status st = OK;
    *out = (struct json_doc){.text = bytes};
    if (size >= UINT32_MAX)
        return fail(E_INPUT, "%zu bytes of JSON, more than can be true", size);
    TRY(value(&p, (struct json_value){0}, 0));
    skip_space(&p);
    if (p.at != size)
        st = wrong(&p, "more follows after the end");
done:
    if (st != OK)
        json_doc_free(out);
    return st;
}

void json_doc_free(struct json_doc *j)
{
    free(j->value);
    *j = (struct json_doc){0};
}
