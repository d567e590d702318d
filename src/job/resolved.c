#include <string.h>

#include "job/parse.h"

/* Where the next line goes: `indent` spaces, and a dash before the first line of a list's item. */
struct page {
    struct text *out;
    int indent;
    bool dash;
};

static void begin_line(struct page *p)
{
    if (p->dash)
        text_add(p->out, "%*s- ", p->indent - 2, "");
    else
        text_add(p->out, "%*s", p->indent, "");
    p->dash = false;
}

static void end_line(struct page *p, const char *unit, const char *meaning)
{
    text_add(p->out, "  # %s%s%s\n", unit, unit[0] ? "; " : "", meaning);
}

void put_quoted(struct text *t, const char *s)
{
    text_add(t, "\"");
    for (; *s; s++) {
        if (*s == '\n')
            text_add(t, "\\n");
        else if (*s == '\t')
            text_add(t, "\\t");
        else if (*s == '"' || *s == '\\')
            text_add(t, "\\%c", *s);
        else
            text_add_bytes(t, s, 1);
    }
    text_add(t, "\"");
}

/* Names need no quotes where they cannot be taken for anything else. */
static void put_key(struct text *t, const char *name)
{
    if (name[0] == '-')
        put_quoted(t, name);
    else
        text_add(t, "%s", name);
}

static void put_vec(struct text *t, const double *v, size_t n)
{
    char number[32];
    for (size_t i = 0; i < n; i++)
        text_add(t, "%s%s", i ? ", " : "[", key_number(v[i], number));
    text_add(t, "]");
}

static void put_sets(struct text *t, const struct job_sets *sets)
{
    text_add(t, "{");
    for (size_t i = 0; i < sets->n; i++) {
        text_add(t, i ? ", " : "");
        put_quoted(t, sets->item[i].path);
        text_add(t, ": %s", sets->item[i].value);
    }
    text_add(t, "}");
}

static void put_curve_value(struct text *t, const struct job_key *key, const struct curve *c, size_t i)
{
    char number[32];
    if (key->type == KEY_TRACK)
        put_vec(t, c->value + i * key->n, key->n);
    else
        text_add(t, "%s", key_number(c->value[i], number));
}

static void put_curve(struct text *t, const struct job_key *key, const struct curve *c)
{
    static const char *const ease[] = {"linear", "smooth", "step"};
    if (c->n == 1) {
        put_curve_value(t, key, c, 0);
        return;
    }
    text_add(t, "{");
    for (size_t i = 0; i < c->n; i++) {
        text_add(t, "%.0f: ", c->frame[i]);
        put_curve_value(t, key, c, i);
        text_add(t, ", ");
    }
    text_add(t, "ease: %s}", ease[c->ease]);
}

static void put_value(struct text *t, const struct job_key *key, const void *base)
{
    const void *member = key_member(key, base);
    char number[48];
    size_t n = 0;
    const char *item;
    char **names;
    const double *points;
    const struct frame_range *ranges;
    switch (key->type) {
    case KEY_TEXT:
    case KEY_NAME:
    case KEY_INPUT:
        put_quoted(t, *(char *const *)member);
        break;
    case KEY_NUM:
        text_add(t, "%s", key_number(*(const double *)member, number));
        break;
    case KEY_INT:
        text_add(t, "%lld", (long long)*(const int64_t *)member);
        break;
    case KEY_CURVE:
    case KEY_TRACK:
        put_curve(t, key, member);
        break;
    case KEY_BOOL:
        text_add(t, *(const bool *)member ? "true" : "false");
        break;
    case KEY_CHOICE:
        item = choice_item(key->choices, *(const int *)member, &n);
        text_add_bytes(t, item, n);
        break;
    case KEY_VEC:
        put_vec(t, member, key->n);
        break;
    case KEY_RANGE:
        text_add(t, "%s", range_text(*(const struct frame_range *)member, number));
        break;
    case KEY_POINTS:
        points = key_items(key, base, &n);
        text_add(t, "[");
        for (size_t i = 0; i < n; i++, points += key->n) {
            text_add(t, i ? ", " : "");
            put_vec(t, points, key->n);
        }
        text_add(t, "]");
        break;
    case KEY_RANGES:
        ranges = key_items(key, base, &n);
        text_add(t, "[");
        for (size_t i = 0; i < n; i++)
            text_add(t, "%s%s", i ? ", " : "", range_text(ranges[i], number));
        text_add(t, "]");
        break;
    case KEY_SETS:
        put_sets(t, member);
        break;
    case KEY_NAMES:
    case KEY_TEXTS:
        names = key_items(key, base, &n);
        text_add(t, "[");
        for (size_t i = 0; i < n; i++) {
            text_add(t, i ? ", " : "");
            put_quoted(t, names[i]);
        }
        text_add(t, "]");
        break;
    case KEY_SUB:
    case KEY_MAYBE:
    case KEY_LIST:
    case KEY_MAP:
    case KEY_NODE:
        break;
    }
}

static void put_section(struct page *p, enum job_section_id section, const void *base, bool named);

static void put_node(struct page *p, const struct job_node *node)
{
    bool shape = node->kind == NODE_SHAPE;
    enum job_section_id section = node_section(node);
    begin_line(p);
    text_add(p->out, "%s:\n", shape ? job_sections[section].name : node_operators[node->kind]);
    p->indent += 2;
    if (shape)
        put_section(p, section, &node->u, false);
    for (size_t i = 0; i < node->n_child; i++) {
        p->indent += 2;
        p->dash = true;
        put_node(p, node->child[i]);
        p->indent -= 2;
    }
    p->indent -= 2;
    if (!shape)
        put_section(p, section, &node->u, false);
}

static void put_items(struct page *p, const struct job_key *key, const void *base)
{
    const struct job_section *child = &job_sections[key->child];
    bool map = key->type == KEY_MAP;
    size_t n;
    const char *items = key_items(key, base, &n);
    if (n == 0)
        text_add(p->out, map ? " {}" : " []");
    end_line(p, "", key->meaning);
    for (size_t i = 0; i < n; i++, items += child->size) {
        p->indent += map ? 2 : 4;
        p->dash = !map;
        for (size_t k = 0; map && k < child->n; k++)
            if (child->key[k].type == KEY_NAME) {
                begin_line(p);
                put_key(p->out, *(char *const *)key_member(&child->key[k], items));
                text_add(p->out, ":\n");
                p->indent += 2;
            }
        put_section(p, (enum job_section_id)key->child, items, map);
        p->indent -= 4;
    }
}

/* `named`: the mapping's key is the name, so it is not repeated inside. */
static void put_section(struct page *p, enum job_section_id section, const void *base, bool named)
{
    const struct job_section *s = &job_sections[section];
    for (size_t i = 0; i < s->n; i++) {
        const struct job_key *key = &s->key[i];
        const void *member = key_member(key, base);
        bool maybe = key->type == KEY_MAYBE, node = key->type == KEY_NODE;
        if (maybe || node)
            member = *(void *const *)member;
        if ((named && key->type == KEY_NAME) || !member)
            continue;
        begin_line(p);
        text_add(p->out, "%s:", key->name);
        if (key->type == KEY_SUB || maybe || node) {
            end_line(p, "", key->meaning);
            p->indent += 2;
            if (node)
                put_node(p, member);
            else
                put_section(p, (enum job_section_id)key->child, member, false);
            p->indent -= 2;
        } else if (key->type == KEY_LIST || key->type == KEY_MAP) {
            put_items(p, key, base);
        } else {
            text_add(p->out, " ");
            put_value(p->out, key, base);
            end_line(p, key->unit, key->meaning);
        }
    }
}

status job_resolved(const struct job *job, struct text *out)
{
    struct page p = {.out = out};
    text_add(out, "# The job as run: every key, defaults filled in. File names are absolute.\n");
    put_section(&p, SECTION_job, job, false);
    return text_status(out);
}
