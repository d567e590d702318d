/* Reads mappings into structs: sections, lists and maps of sections, and CSG nodes. */
#include <stdio.h>
#include <string.h>

#include "base/memory.h"
#include "job/parse.h"
#include "text/nearest.h"

/* Limit of nested operators. Each takes two levels of YAML, so this is within YAML_DEPTH. */
enum { NODE_DEPTH = 24, MAX_KEYS = 64 };

/* Limit of items in a list, because some checks compare each item with all others. */
enum { LIST_ITEMS = 4096 };

/* The advice for a removed key; NULL if there was no such key. */
static const char *instead_of(enum job_section_id section, const char *key)
{
    static const struct {
        enum job_section_id section;
        const char *key, *instead;
    } gone[] = {
#define GONE(section, key, instead) {SECTION_##section, #key, instead},
#include "job/keys.def"
    };
    for (size_t i = 0; i < sizeof gone / sizeof *gone; i++)
        if (gone[i].section == section && strcmp(gone[i].key, key) == 0)
            return gone[i].instead;
    return NULL;
}

static status unknown_key(enum job_section_id section, const struct yaml *at, const char *const *names,
                          size_t n)
{
    char list[600];
    size_t used = 0;
    const char *instead = instead_of(section, at->key);
    if (instead)
        return yaml_fail_key(at, "replaced by %s", instead);
    const char *near = nearest_word(at->key, names, n);
    if (near)
        return yaml_fail_key(at, "unknown key; did you mean %s?", near);
    list[0] = '\0';
    for (size_t i = 0; i < n && used < 500; i++)
        used += (size_t)snprintf(list + used, sizeof list - used, "%s %.60s", i ? "," : "", names[i]);
    return yaml_fail_key(at, "unknown key; known here:%s", list);
}

static status read_node(const struct yaml *map, const char *folder, int depth, struct job_node **out);

static status read_list(const struct job_key *key, const struct yaml *v, const char *folder, void *base)
{
    const struct job_section *child = &job_sections[key->child];
    bool map = key->type == KEY_MAP;
    char *items = NULL;
    if (v->kind != (map ? YAML_MAP : YAML_LIST))
        return yaml_fail(v, NULL, "%s where %s is expected (%s)", yaml_what(v),
                         map ? "a mapping {name: {...}, ...}" : "a list of mappings", key->meaning);
    if (v->n > LIST_ITEMS)
        return yaml_fail(v, NULL, "%zu items (at most %d)", v->n, LIST_ITEMS);
    status st = memory_alloc(v->n, child->size, key->name, &items);
    if (st != OK)
        return st;
    key_set_items(key, base, items, v->n);
    for (const struct yaml *item = v->first; item && st == OK; item = item->next, items += child->size)
        st = read_section((enum job_section_id)key->child, item, map ? item->key : NULL, folder, items);
    return st;
}

static status read_maybe(const struct job_key *key, const struct yaml *v, const char *folder, void *base)
{
    void *child = NULL;
    status st = memory_alloc(1, job_sections[key->child].size, key->name, &child);
    if (st != OK)
        return st;
    memcpy(key_member(key, base), &child, sizeof child);
    return read_section((enum job_section_id)key->child, v, NULL, folder, child);
}

static status read_key(const struct job_key *key, const struct yaml *v, const char *folder, void *base)
{
    switch (key->type) {
    case KEY_SUB:
        return read_section((enum job_section_id)key->child, v, NULL, folder, key_member(key, base));
    case KEY_MAYBE:
        return read_maybe(key, v, folder, base);
    case KEY_LIST:
    case KEY_MAP:
        return read_list(key, v, folder, base);
    case KEY_NODE:
        return read_node(v, folder, 0, key_member(key, base));
    default:
        return read_value(key, v, folder, base);
    }
}

/* The key of an item of a MAP is its name, which is checked like any other name. */
static status read_item_name(const struct job_key *key, const struct yaml *map, const char *name, void *base)
{
    struct yaml text = *map;
    text.kind = YAML_SCALAR;
    text.quoted = true;
    text.text = name;
    text.line = map->key_line;
    text.column = map->key_column;
    return read_value(key, &text, NULL, base);
}

status read_section(enum job_section_id section, const struct yaml *map, const char *name, const char *folder,
                    void *base)
{
    const struct job_section *s = &job_sections[section];
    const char *names[MAX_KEYS];
    size_t n = 0;
    if (map->kind != YAML_MAP)
        return yaml_fail(map, NULL, "%s where a mapping is expected (%s)", yaml_what(map), s->meaning);
    for (size_t i = 0; i < s->n && n < MAX_KEYS; i++)
        if (!(name && s->key[i].type == KEY_NAME))
            names[n++] = s->key[i].name;
    for (const struct yaml *v = map->first; v; v = v->next) {
        const struct job_key *key = table_find(section, v->key);
        if (key && name && key->type == KEY_NAME)
            return yaml_fail_key(v, "already named by its key: %.64s", name);
        if (!key)
            return unknown_key(section, v, names, n);
    }
    for (size_t i = 0; i < s->n; i++) {
        const struct job_key *key = &s->key[i];
        const struct yaml *v = yaml_get(map, key->name);
        status st = name && key->type == KEY_NAME ? read_item_name(key, map, name, base)
                    : v                           ? read_key(key, v, folder, base)
                                                  : read_default(key, map, key->name, base);
        if (st != OK)
            return st;
    }
    return check_section(section, map, base);
}

static int find_operator(const char *name)
{
    for (int i = 0; i < NODE_SHAPE; i++)
        if (strcmp(node_operators[i], name) == 0)
            return i;
    return -1;
}

static int find_shape(const char *name)
{
    for (int i = 0; i < SHAPES; i++)
        if (strcmp(job_sections[i].name, name) == 0)
            return i;
    return -1;
}

static status unknown_node_key(const struct yaml *at)
{
    const char *names[NODE_SHAPE + SHAPES + MAX_KEYS];
    size_t n = 0;
    const struct job_section *group = &job_sections[SECTION_group];
    for (size_t i = 0; i < NODE_SHAPE; i++)
        names[n++] = node_operators[i];
    for (size_t i = 0; i < SHAPES; i++)
        names[n++] = job_sections[i].name;
    for (size_t i = 0; i < group->n; i++)
        names[n++] = group->key[i].name;
    return unknown_key(SECTION_group, at, names, n);
}

/* Finds the operator or shape of a node's mapping. */
static status find_what(const struct yaml *map, const struct yaml **out)
{
    const struct yaml *what = NULL;
    if (map->kind != YAML_MAP)
        return yaml_fail(
            map, NULL,
            "%s where a mapping is expected, with one shape (such as box) or one operator (such as union)",
            yaml_what(map));
    for (const struct yaml *v = map->first; v; v = v->next) {
        if (find_operator(v->key) < 0 && find_shape(v->key) < 0) {
            if (key_places(v->key))
                continue;
            return unknown_node_key(v);
        }
        if (what)
            return yaml_fail_key(v, "a second shape or operator beside %.20s; put both in a union",
                                 what->key);
        what = v;
    }
    if (!what)
        return yaml_fail(map, NULL, "neither a shape (such as box) nor an operator (such as union) is given");
    *out = what;
    return OK;
}

/* Reads the keys of `group` beside an operator. */
static status read_group(const struct yaml *map, const char *folder, struct job_node *node)
{
    const struct job_section *group = &job_sections[SECTION_group];
    status st = OK;
    for (size_t i = 0; i < group->n && st == OK; i++) {
        const struct job_key *key = &group->key[i];
        const struct yaml *v = yaml_get(map, key->name);
        st = v ? read_key(key, v, folder, &node->u) : read_default(key, map, key->name, &node->u);
    }
    return st;
}

static status read_operator(const struct yaml *map, const struct yaml *list, const char *folder, int depth,
                            struct job_node *node)
{
    if (list->kind != YAML_LIST || list->n == 0)
        return yaml_fail(list, NULL, "%s where a list of at least one shape is expected",
                         list->kind == YAML_LIST ? "an empty list" : yaml_what(list));
    if (depth == NODE_DEPTH)
        return yaml_fail(list, NULL, "operators are nested more than %d deep", NODE_DEPTH);
    status st = read_group(map, folder, node);
    if (st == OK)
        st = memory_alloc(list->n, sizeof *node->child, "a shape's parts", &node->child);
    for (const struct yaml *v = list->first; v && st == OK; v = v->next)
        st = read_node(v, folder, depth + 1, &node->child[node->n_child++]);
    return st;
}

static status read_node(const struct yaml *map, const char *folder, int depth, struct job_node **out)
{
    const struct yaml *what = NULL;
    struct job_node *node = NULL;
    status st = find_what(map, &what);
    if (st != OK || (st = memory_alloc(1, sizeof *node, "a shape", &node)) != OK)
        return st;
    *out = node;
    int kind = find_operator(what->key);
    if (kind >= 0) {
        node->kind = (enum job_node_kind)kind;
        return read_operator(map, what, folder, depth, node);
    }
    node->kind = NODE_SHAPE;
    node->shape = (enum job_shape)find_shape(what->key);
    for (const struct yaml *v = map->first; v; v = v->next)
        if (v != what)
            return yaml_fail_key(v, "belongs inside %.20s", what->key);
    return read_section(node_section(node), what, NULL, folder, &node->u);
}
