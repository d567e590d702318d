#include "job/yaml.h"

#include <math.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"

struct yaml_block {
    struct yaml_block *next;
    size_t used, size;
    max_align_t bytes[];
};

status yaml_alloc(struct yaml_tree *tree, size_t size, void *out)
{
    enum { BLOCK = 64 << 10 };
    struct yaml_block *b = tree->blocks;
    size = (size + sizeof(max_align_t) - 1) / sizeof(max_align_t) * sizeof(max_align_t);
    if (!b || b->size - b->used < size) {
        size_t room = size > BLOCK ? size : BLOCK;
        status st = memory_alloc(1, sizeof *b + room, "the job file's text", &b);
        if (st != OK)
            return st;
        b->next = tree->blocks;
        b->size = room;
        tree->blocks = b;
    }
    void *p = (char *)b->bytes + b->used;
    b->used += size;
    memcpy(out, &p, sizeof p);
    return OK;
}

status yaml_copy(struct yaml_tree *tree, const char *text, size_t n, const char **out)
{
    char *copy = NULL;
    status st = yaml_alloc(tree, n + 1, &copy);
    if (st == OK && n)
        memcpy(copy, text, n);
    *out = copy;
    return st;
}

void yaml_free(struct yaml_tree *tree)
{
    while (tree->blocks) {
        struct yaml_block *b = tree->blocks;
        tree->blocks = b->next;
        free(b);
    }
    tree->n_values = 0;
}

status yaml_new(struct yaml_tree *tree, enum yaml_kind kind, const struct yaml_source *source,
                struct yaml **out)
{
    status st = yaml_alloc(tree, sizeof **out, out);
    if (st != OK)
        return st;
    (*out)->kind = kind;
    (*out)->source = source;
    if (++tree->n_values > YAML_VALUES)
        return yaml_fail(*out, NULL, "more than %d values", YAML_VALUES);
    return OK;
}

void yaml_append(struct yaml *parent, struct yaml *child)
{
    child->parent = parent;
    child->next = NULL;
    if (parent->last)
        parent->last->next = child;
    else
        parent->first = child;
    parent->last = child;
    parent->n++;
}

struct yaml *yaml_get(const struct yaml *map, const char *key)
{
    if (map && map->kind == YAML_MAP)
        for (struct yaml *v = map->first; v; v = v->next)
            if (strcmp(v->key, key) == 0)
                return v;
    return NULL;
}

struct yaml *yaml_item(const struct yaml *list, size_t i)
{
    struct yaml *v = list->first;
    while (v && i-- > 0)
        v = v->next;
    return v;
}

bool yaml_is_null(const struct yaml *value)
{
    const char *t = value->text;
    return value->kind == YAML_SCALAR && !value->quoted &&
           (!*t || !strcmp(t, "~") || !strcmp(t, "null") || !strcmp(t, "Null") || !strcmp(t, "NULL"));
}

const char *yaml_what(const struct yaml *value)
{
    double number;
    if (value->kind == YAML_MAP)
        return "a mapping";
    if (value->kind == YAML_LIST)
        return "a list";
    if (yaml_is_null(value))
        return "an empty value";
    if (value->quoted)
        return "text";
    if (yaml_decimal(value->text, &number))
        return "a number";
    if (!strcmp(value->text, "true") || !strcmp(value->text, "false"))
        return "true or false";
    return "text";
}

bool yaml_decimal(const char *text, double *out)
{
    const char *s = text + (*text == '+' || *text == '-');
    size_t whole = strspn(s, "0123456789");
    s += whole;
    size_t fraction = 0;
    if (*s == '.') {
        fraction = strspn(++s, "0123456789");
        s += fraction;
    }
    if (whole + fraction == 0)
        return false;
    if (*s == 'e' || *s == 'E') {
        s++;
        s += *s == '+' || *s == '-';
        size_t exponent = strspn(s, "0123456789");
        if (!exponent)
            return false;
        s += exponent;
    }
    if (*s)
        return false;
    *out = strtod(text, NULL);
    return isfinite(*out);
}

/* Appends the key path of `at`, such as "strata.0.to_m", to the `used` bytes of `out`; returns the bytes used. */
static size_t path_text(const struct yaml *at, char *out, size_t used, size_t size)
{
    char part[80];
    if (!at->parent)
        return used;
    used = path_text(at->parent, out, used, size);
    if (at->key) {
        snprintf(part, sizeof part, "%.64s", at->key);
    } else {
        size_t i = 0;
        for (const struct yaml *v = at->parent->first; v != at; v = v->next)
            i++;
        snprintf(part, sizeof part, "%zu", i);
    }
    int n = snprintf(out + used, size - used, "%s%s", used ? "." : "", part);
    return n > 0 && (size_t)n < size - used ? used + (size_t)n : used;
}

static status vfail(const struct yaml *at, const char *below, int line, int column, const char *format,
                    va_list args)
{
    char path[700] = "", place[700] = "", message[900];
    size_t used = path_text(at, path, 0, sizeof path);
    if (below)
        snprintf(path + used, sizeof path - used, "%s%s", used ? "." : "", below);
    vsnprintf(message, sizeof message, format, args);
    const char *set = at->source->set;
    if (set)
        snprintf(place, sizeof place, "--set %.600s: ", set);
    else
        snprintf(place, sizeof place, "%.600s:%d:%d: ", at->source->file, line, column);
    bool same = !path[0] || (set && strcmp(set, path) == 0);
    return fail(E_USAGE, "%s%s%s%s", place, same ? "" : path, same ? "" : ": ", message);
}

status yaml_fail(const struct yaml *at, const char *below, const char *format, ...)
{
    va_list args;
    va_start(args, format);
    status st = vfail(at, below, at->line, at->column, format, args);
    va_end(args);
    return st;
}

status yaml_fail_key(const struct yaml *at, const char *format, ...)
{
    va_list args;
    va_start(args, format);
    status st = vfail(at, NULL, at->key_line, at->key_column, format, args);
    va_end(args);
    return st;
}
