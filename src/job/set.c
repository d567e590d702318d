#include <ctype.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "job/parse.h"

/* A key path split into parts: "strata[0].to_m" and "strata.0.to_m" have the parts strata, 0, to_m. */
struct key_path {
    const char *part[YAML_DEPTH];
    size_t n;
};

/* A setting, and its origin: --set, or the item `at` of an edit's `set`. */
struct setting {
    const char *path;
    const struct yaml_source *source;
    const struct yaml *at; /* NULL: --set */
};

PRINTF_LIKE(2, 3) static status refuse(const struct setting *s, const char *format, ...)
{
    char message[400];
    va_list args;
    va_start(args, format);
    vsnprintf(message, sizeof message, format, args);
    va_end(args);
    return s->at ? yaml_fail_key(s->at, "%s", message) : fail(E_USAGE, "--set %.200s: %s", s->path, message);
}

static status cut_path(struct yaml_tree *tree, const struct setting *setting, struct key_path *out)
{
    const char *text = setting->path, *s = text;
    out->n = 0;
    for (;;) {
        size_t n = strcspn(s, ".[]");
        bool bracket = s > text && s[-1] == '[';
        if (n == 0 || (bracket ? s[n] != ']' : s[n] == ']'))
            return refuse(setting, "not a key path (such as wind.speed_m_s or strata.0.to_m)");
        if (out->n == YAML_DEPTH)
            return refuse(setting, "more than %d keys deep", YAML_DEPTH);
        status st = yaml_copy(tree, s, n, &out->part[out->n++]);
        if (st != OK)
            return st;
        s += n + bracket;
        if (!*s)
            return OK;
        if (*s != '.' && *s != '[')
            return refuse(setting, "not a key path (such as wind.speed_m_s or strata.0.to_m)");
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

/* Replaces `old` by `value` among its siblings. */
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

/* Creates a missing value on the way to a key: a list if the table says so, else a mapping. */
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
        if (key && (key->type == KEY_SUB || key->type == KEY_MAYBE))
            section = key->child;
        else if (key)
            return YAML_MAP;
        key = table_find((enum job_section_id)section, path->part[i]);
        if (!key)
            return YAML_MAP;
    }
    return key && key->type == KEY_LIST ? YAML_LIST : YAML_MAP;
}

/* The value at `path` below the root, created if it is missing. */
static status reach(struct yaml_tree *tree, struct yaml *root, const struct key_path *path,
                    const struct setting *setting, struct yaml **out)
{
    struct yaml *at = root;
    for (size_t i = 0; i < path->n; i++) {
        const char *part = path->part[i];
        struct yaml *next = NULL;
        size_t index = 0;
        if (at->kind == YAML_SCALAR && setting->at)
            return refuse(setting, "reaches into %s; set the whole of it", yaml_what(at));
        if (at->kind == YAML_SCALAR)
            return yaml_fail(at, NULL, "--set %.200s reaches into %s; set the whole of it", setting->path,
                             yaml_what(at));
        if (at->kind == YAML_LIST) {
            index = list_index(part);
            if (index > at->n)
                return refuse(setting, "%.64s is not one of the list's %zu items (0 the first, %zu appends)",
                              part, at->n, at->n);
            next = yaml_item(at, index);
        } else {
            next = yaml_get(at, part);
        }
        if (!next) {
            status st = yaml_new(tree, kind_of(path, i), setting->source, &next);
            if (st != OK)
                return st;
            next->key = at->kind == YAML_MAP ? part : NULL;
            if (setting->at) {
                next->line = setting->at->line;
                next->column = setting->at->column;
                next->key_line = setting->at->key_line;
                next->key_column = setting->at->key_column;
            }
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
    struct setting setting = {0};
    status st = OK;
    if (!equals || equals == set)
        return fail(E_USAGE, "--set %.200s: write key.path=value, such as wind.speed_m_s=12", set);
    TRY(yaml_alloc(tree, sizeof *source, &source));
    source->file = "--set";
    TRY(yaml_copy(tree, set, (size_t)(equals - set), &source->set));
    setting = (struct setting){source->set, source, NULL};
    TRY(cut_path(tree, &setting, &path));
    TRY(yaml_parse(tree, equals + 1, strlen(equals + 1), source, &value));
    TRY(reach(tree, root, &path, &setting, &at));
    replace(at, value);
done:
    return st;
}

/* ---- settings of edits */

/* Keys that determine the initial state, which an edit cannot change. */
static const char *const fixed[] = {"hoodoo",   "name",        "model",  "frames",     "from",
                                    "seed",     "domain",      "scene",  "paint",      "edits",
                                    "attitude", "strata_from", "joints", "concretions"};

bool job_settable(const char *top)
{
    const struct job_key *key = table_find(SECTION_job, top);
    for (size_t i = 0; i < sizeof fixed / sizeof *fixed; i++)
        if (strcmp(fixed[i], top) == 0)
            return false;
    return key && key_simulates(key);
}

/* The table's row of the last part; NULL if there is none, or if the last part is an index. */
static const struct job_key *last_key(const struct key_path *path)
{
    int section = SECTION_job;
    const struct job_key *key = NULL;
    for (size_t i = 0; i < path->n; i++) {
        if (key && (key->type == KEY_LIST || key->type == KEY_MAP)) {
            section = key->child;
            key = NULL;
            continue;
        }
        if (key && key->type != KEY_SUB && key->type != KEY_MAYBE)
            return key; /* inside a value: a curve, a vector */
        if (key)
            section = key->child;
        key = table_find((enum job_section_id)section, path->part[i]);
        if (!key)
            return NULL;
    }
    return key;
}

status job_set_edit(struct yaml_tree *tree, struct yaml *root, const struct yaml *value)
{
    struct key_path path;
    struct yaml *at = NULL;
    const struct setting setting = {value->key, value->source, value};
    status st = OK;
    TRY(cut_path(tree, &setting, &path));
    const struct job_key *key = table_find(SECTION_job, path.part[0]), *last = last_key(&path);
    if (key && !job_settable(path.part[0]))
        return key_simulates(key) || key->type == KEY_RANGE
                   ? refuse(&setting, "an edit cannot change %.64s", path.part[0])
                   : refuse(&setting, "an edit changes what is simulated, and this only what is written");
    if (last && (!key_simulates(last) || strcmp(last->name, "bed_m") == 0))
        return refuse(&setting, key_simulates(last)
                                    ? "beds are taken out at the start; use this edit's carve"
                                    : "an edit changes what is simulated, and this only what is written");
    TRY(reach(tree, root, &path, &setting, &at));
    replace(at, value);
done:
    return st;
}
