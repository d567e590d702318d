#include "job/table.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "text/text.h"

/* One row. Parameters end in _ so that they are not substituted in the designators. */
#define ROW(section_, key_, type_, use_, unit_, meaning_, source_, ...)                                      \
    {.type = type_,                                                                                          \
     .use = use_,                                                                                            \
     .name = #key_,                                                                                          \
     .unit = unit_,                                                                                          \
     .meaning = meaning_,                                                                                    \
     .source = source_,                                                                                      \
     .offset = offsetof(struct job_##section_, key_),                                                        \
     __VA_ARGS__},

#define SECTION(s_, meaning_) static const struct job_key keys_##s_[] = {
#define END(s_)                                                                                              \
    }                                                                                                        \
    ;
#define TEXT(s_, key_, use_, preset_, meaning_, source_)                                                     \
    ROW(s_, key_, KEY_TEXT, use_, "", meaning_, source_, .preset = preset_)
#define WORD(s_, key_, use_, preset_, meaning_, source_)                                                     \
    ROW(s_, key_, KEY_TEXT, use_, "", meaning_, source_, .preset = preset_, .n = 1)
#define NAME(s_, key_, use_, preset_, meaning_, source_)                                                     \
    ROW(s_, key_, KEY_NAME, use_, "", meaning_, source_, .preset = preset_)
#define INPUT(s_, key_, use_, preset_, meaning_, source_)                                                    \
    ROW(s_, key_, KEY_INPUT, use_, "", meaning_, source_, .preset = preset_)
#define RANGE(s_, key_, use_, preset_, meaning_, source_)                                                    \
    ROW(s_, key_, KEY_RANGE, use_, "", meaning_, source_, .preset = preset_)
#define NUM(s_, key_, use_, unit_, number_, min_, max_, meaning_, source_)                                   \
    ROW(s_, key_, KEY_NUM, use_, unit_, meaning_, source_, .number = number_, .min = min_, .max = max_)
#define CURVE(s_, key_, use_, unit_, number_, min_, max_, meaning_, source_)                                 \
    ROW(s_, key_, KEY_CURVE, use_, unit_, meaning_, source_, .number = number_, .min = min_, .max = max_)
#define TRACK(s_, key_, use_, unit_, preset_, min_, max_, meaning_, source_)                                 \
    ROW(s_, key_, KEY_TRACK, use_, unit_, meaning_, source_, .preset = preset_, .n = 3, .min = min_,         \
        .max = max_)
#define INT(s_, key_, use_, unit_, number_, min_, max_, meaning_, source_)                                   \
    ROW(s_, key_, KEY_INT, use_, unit_, meaning_, source_, .number = number_, .min = min_, .max = max_)
#define BOOL(s_, key_, use_, number_, meaning_, source_)                                                     \
    ROW(s_, key_, KEY_BOOL, use_, "", meaning_, source_, .number = number_)
#define CHOICE(s_, key_, use_, preset_, choices_, meaning_, source_)                                         \
    ROW(s_, key_, KEY_CHOICE, use_, "", meaning_, source_, .preset = preset_,                                \
        .choices = CHOICE_TEXT(choices_))
#define VEC(s_, key_, use_, unit_, n_, preset_, min_, max_, meaning_, source_)                               \
    ROW(s_, key_, KEY_VEC, use_, unit_, meaning_, source_, .preset = preset_, .n = n_, .min = min_,          \
        .max = max_)
#define SUB(s_, key_, child_, meaning_)                                                                      \
    ROW(s_, key_, KEY_SUB, SIM, "", meaning_, "", .child = SECTION_##child_)
#define ITEMS(s_, key_, type_, child_, meaning_)                                                             \
    ROW(s_, key_, type_, SIM, "", meaning_, "", .child = child_,                                             \
        .offset_n = offsetof(struct job_##s_, n_##key_))
#define LIST(s_, key_, child_, meaning_) ITEMS(s_, key_, KEY_LIST, SECTION_##child_, meaning_)
#define MAP(s_, key_, child_, meaning_) ITEMS(s_, key_, KEY_MAP, SECTION_##child_, meaning_)
#define MAYBE(s_, key_, child_, meaning_)                                                                    \
    ROW(s_, key_, KEY_MAYBE, SIM, "", meaning_, "", .child = SECTION_##child_)
#define MAYBE_NODE(s_, key_, meaning_) ROW(s_, key_, KEY_NODE, SIM, "", meaning_, "", .preset = "")
#define RANGES(s_, key_, use_, meaning_)                                                                     \
    ROW(s_, key_, KEY_RANGES, use_, "", meaning_, "", .offset_n = offsetof(struct job_##s_, n_##key_))
#define SETS(s_, key_, meaning_) ROW(s_, key_, KEY_SETS, SIM, "", meaning_, "", .preset = "")
#define NODE(s_, key_, meaning_) ROW(s_, key_, KEY_NODE, SIM, "", meaning_, "", .preset = NULL)
#define POINTS(s_, key_, use_, unit_, width_, min_, max_, meaning_, source_)                                 \
    ROW(s_, key_, KEY_POINTS, use_, unit_, meaning_, source_, .n = width_, .min = min_, .max = max_,         \
        .offset_n = offsetof(struct job_##s_, n_##key_))
#define NAMES(s_, key_, use_, meaning_)                                                                      \
    ROW(s_, key_, KEY_NAMES, use_, "", meaning_, "", .offset_n = offsetof(struct job_##s_, n_##key_))
#define TEXTS(s_, key_, use_, meaning_)                                                                      \
    ROW(s_, key_, KEY_TEXTS, use_, "", meaning_, "", .offset_n = offsetof(struct job_##s_, n_##key_))
#include "job/keys.def"

const struct job_section job_sections[JOB_SECTIONS] = {
#define SECTION(section, meaning)                                                                            \
    {#section, meaning, sizeof(struct job_##section), keys_##section,                                        \
     sizeof keys_##section / sizeof keys_##section[0]},
#include "job/keys.def"
};

const char *const node_operators[NODE_SHAPE] = {"union", "intersection", "difference"};

enum job_section_id node_section(const struct job_node *node)
{
    return node->kind == NODE_SHAPE ? (enum job_section_id)node->shape : SECTION_group;
}

const struct job_key *table_find(enum job_section_id section, const char *name)
{
    const struct job_section *s = &job_sections[section];
    for (size_t i = 0; i < s->n; i++)
        if (strcmp(s->key[i].name, name) == 0)
            return &s->key[i];
    return NULL;
}

bool key_required(const struct job_key *key)
{
    switch (key->type) {
    case KEY_TEXT:
    case KEY_NAME:
    case KEY_INPUT:
    case KEY_RANGE:
    case KEY_CHOICE:
    case KEY_VEC:
    case KEY_NODE:
    case KEY_TRACK:
        return key->preset == NULL;
    case KEY_NUM:
    case KEY_CURVE:
    case KEY_INT:
    case KEY_BOOL:
        return isnan(key->number);
    case KEY_SUB:
    case KEY_LIST:
    case KEY_MAP:
    case KEY_POINTS:
    case KEY_NAMES:
    case KEY_MAYBE:
    case KEY_RANGES:
    case KEY_SETS:
    case KEY_TEXTS:
        break;
    }
    return false;
}

static bool any_key(const struct job_key *key, bool (*is)(enum key_use use))
{
    if (key->type != KEY_SUB && key->type != KEY_MAYBE && key->type != KEY_LIST && key->type != KEY_MAP)
        return is(key->use);
    const struct job_section *child = &job_sections[key->child];
    for (size_t i = 0; i < child->n; i++)
        if (any_key(&child->key[i], is))
            return true;
    return false;
}

static bool simulated(enum key_use use)
{
    return use == SIM || use == LATER;
}

static bool filed(enum key_use use)
{
    return use == FILES;
}

bool key_simulates(const struct job_key *key)
{
    return any_key(key, simulated);
}

bool key_files(const struct job_key *key)
{
    return any_key(key, filed);
}

bool key_later(const struct job_key *key)
{
    if (key->type != KEY_SUB && key->type != KEY_MAYBE && key->type != KEY_LIST && key->type != KEY_MAP)
        return key->use == LATER;
    const struct job_section *child = &job_sections[key->child];
    for (size_t i = 0; i < child->n; i++)
        if (key_simulates(&child->key[i]) && !key_later(&child->key[i]))
            return false;
    return key_simulates(key);
}

bool key_places(const char *name)
{
    return table_find(SECTION_group, name) != NULL;
}

const char *choice_item(const char *choices, int i, size_t *n)
{
    for (; i > 0 && choices; i--) {
        choices = strchr(choices, '|');
        if (choices)
            choices++;
    }
    if (choices)
        *n = strcspn(choices, "|");
    return choices;
}

const char *key_number(double value, char out[32])
{
    double size = fabs(value);
    if (size == 0 || (size >= 1e-3 && size < 1e6)) {
        for (int decimals = 0; decimals < 20; decimals++) {
            snprintf(out, 32, "%.*f", decimals, value);
            if (strtod(out, NULL) == value)
                return out;
        }
    }
    number_text(value, out);
    char *e = strchr(out, 'e');
    if (e) {
        /* 1e+06 -> 1e6, 1e-06 -> 1e-6 */
        char *to = e + 1, *from = e + 1;
        if (*from == '-')
            to++;
        from += *from == '+' || *from == '-';
        while (from[0] == '0' && from[1])
            from++;
        memmove(to, from, strlen(from) + 1);
    }
    return out;
}

const char *key_allowed(const struct job_key *key, char out[256])
{
    char low[32], high[32];
    size_t n, used = 0;
    const char *item;
    out[0] = '\0';
    switch (key->type) {
    case KEY_BOOL:
        return strcpy(out, "true or false");
    case KEY_CHOICE:
        for (int i = 0; (item = choice_item(key->choices, i, &n)) != NULL && used < 200; i++)
            used += (size_t)snprintf(out + used, 256 - used, "%s%.*s", i ? ", " : "", (int)n, item);
        return out;
    case KEY_NUM:
    case KEY_CURVE:
    case KEY_INT:
    case KEY_VEC:
    case KEY_TRACK:
    case KEY_POINTS:
        snprintf(out, 256, "%s..%s%s%s", key_number(key->min, low), key_number(key->max, high),
                 key->unit[0] ? " " : "", key->unit);
        return out;
    case KEY_TEXT:
    case KEY_NAME:
    case KEY_INPUT:
    case KEY_RANGE:
    case KEY_SUB:
    case KEY_LIST:
    case KEY_MAP:
    case KEY_NODE:
    case KEY_NAMES:
    case KEY_MAYBE:
    case KEY_RANGES:
    case KEY_SETS:
    case KEY_TEXTS:
        break;
    }
    return out;
}

void *key_member(const struct job_key *key, const void *base)
{
    return (char *)(uintptr_t)base + key->offset;
}

void *key_items(const struct job_key *key, const void *base, size_t *n)
{
    void *items;
    memcpy(&items, (const char *)base + key->offset, sizeof items);
    memcpy(n, (const char *)base + key->offset_n, sizeof *n);
    return items;
}

void key_set_items(const struct job_key *key, void *base, void *items, size_t n)
{
    memcpy((char *)base + key->offset, &items, sizeof items);
    memcpy((char *)base + key->offset_n, &n, sizeof n);
}
