#include <ctype.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "job/parse.h"

/* A key path, cut: "strata[0].to_m" and "strata.0.to_m" have the parts strata, 0, to_m. */
struct key_path {
    const char *part[YAML_DEPTH];
    size_t n;
};

static status cut_path(struct yaml_tree *tree, const char *text, struct key_path *out)
{
    const char *s = text;
    out->n = 0;
    for (;;) {
        size_t n = strcspn(s, ".[]");
        bool bracket = s > text && s[-1] == '[';
        if (n == 0 || (bracket ? s[n] != ']' : s[n] == ']'))
            return fail(E_USAGE, "--set %.200s: not a key path (such as wind.speed_m_s or strata.0.to_m)",
                        text);
        if (out->n == YAML_DEPTH)
            return fail(E_USAGE, "--set %.200s: more than %d keys deep", text, YAML_DEPTH);
        status st = yaml_copy(tree, s, n, &out->part[out->n++]);
        if (st != OK)
            return st;
        s += n + bracket;
        if (!*s)
            return OK;
        if (*s != '.' && *s != '[')
            return fail(E_USAGE, "--set %.200s: not a key path (such as wind.speed_m_s or strata.0.to_m)",
                        text);
        s++;
    }
}

/* SIZE_MAX if it is not an index. */
static size_t list_index(const char *part)
{
    size_t i = 0;
    if (strlen(part) > 7)
        return SIZE_MAX;
    for (; *part; part++) {
        if (!isdigit((unsigned char)*part))
            return SIZE_MAX;
        i = i * 10 + (size_t)(*part - '0');
    }
    return i;
}

/* `old` becomes `value`, in its place among its siblings. */
static void replace(struct yaml *old, const struct yaml *value)
{
    struct yaml keep = *old;
    *old = *value;
    old->parent = keep.parent;
    old->next = keep.next;
    old->key = keep.key;
    old->key_line = keep.key_line;
    old->key_column = keep.key_column;
    for (struct yaml *v = old->first; v; v = v->next)
        v->parent = old;
}

/* Where the table says a list stands, an absent one is made as such; everything else in between is a mapping.
 */
static enum yaml_kind kind_of(const struct key_path *path, size_t depth)
{
    int section = SECTION_job;
    const struct job_key *key = NULL;
    for (size_t i = 0; i <= depth; i++) {
        if (key && (key->type == KEY_LIST || key->type == KEY_MAP)) {
            section = key->child;
            key = NULL;
            continue;
        }
        if (key && key->type == KEY_SUB)
            section = key->child;
        else if (key)
            return YAML_MAP;
        key = table_find((enum job_section_id)section, path->part[i]);
        if (!key)
            return YAML_MAP;
    }
    return key && key->type == KEY_LIST ? YAML_LIST : YAML_MAP;
}

/* The value `path` names under root, made if it is not there. */
static status reach(struct yaml_tree *tree, struct yaml *root, const struct key_path *path,
                    const struct yaml_source *source, struct yaml **out)
{
    struct yaml *at = root;
    for (size_t i = 0; i < path->n; i++) {
        const char *part = path->part[i];
        struct yaml *next = NULL;
        size_t index = 0;
        if (at->kind == YAML_SCALAR)
            return yaml_fail(at, NULL, "--set %.200s reaches into %s; set the whole of it", source->set,
                             yaml_what(at));
        if (at->kind == YAML_LIST) {
            index = list_index(part);
            if (index > at->n)
                return fail(
                    E_USAGE,
                    "--set %.200s: %.64s is not one of the list's %zu items (0 the first, %zu appends)",
                    source->set, part, at->n, at->n);
            next = yaml_item(at, index);
        } else {
            next = yaml_get(at, part);
        }
        if (!next) {
            status st = yaml_new(tree, kind_of(path, i), source, &next);
            if (st != OK)
                return st;
            next->key = at->kind == YAML_MAP ? part : NULL;
            yaml_append(at, next);
        }
        at = next;
    }
    *out = at;
    return OK;
}

status job_set(struct yaml_tree *tree, struct yaml *root, const char *set)
{
    struct key_path path;
    struct yaml_source *source = NULL;
    struct yaml *value = NULL, *at = NULL;
    const char *equals = strchr(set, '=');
    status st = OK;
    if (!equals || equals == set)
        return fail(E_USAGE, "--set %.200s: write key.path=value, such as wind.speed_m_s=12", set);
    TRY(yaml_alloc(tree, sizeof *source, &source));
    source->file = "--set";
    TRY(yaml_copy(tree, set, (size_t)(equals - set), &source->set));
    TRY(cut_path(tree, source->set, &path));
    TRY(yaml_parse(tree, equals + 1, strlen(equals + 1), source, &value));
    TRY(reach(tree, root, &path, source, &at));
    replace(at, value);
done:
    return st;
}
