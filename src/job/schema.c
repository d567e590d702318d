/* The keys as a JSON Schema (draft 2020-12), for editors that complete and check while typing. Rules that it cannot express, such as
 * which keys exclude each other, are checked when the job is loaded. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "job/job.h"
#include "job/table.h"

static const char FRAME[] = "^-?[0-9]+$", RANGE[] = "^-?[0-9]+(-(-?[0-9]+)(x[0-9]+)?)?$";

static void type(struct text *t, const char *name)
{
    json_text(t, "type", name);
}

static void reference(struct text *t, const char *section)
{
    char path[80];
    snprintf(path, sizeof path, "#/$defs/%.60s", section);
    json_text(t, "$ref", path);
}

static void bounds(struct text *t, const struct job_key *key)
{
    json_number(t, "minimum", key->min);
    json_number(t, "maximum", key->max);
}

/* [x, y, z] */
static void vector(struct text *t, const struct job_key *key)
{
    type(t, "array");
    json_integer(t, "minItems", (int64_t)key->n);
    json_integer(t, "maxItems", (int64_t)key->n);
    json_object(t, "items");
    type(t, "number");
    bounds(t, key);
    json_end_object(t);
}

static void number_or_vector(struct text *t, const struct job_key *key)
{
    if (key->type == KEY_TRACK) {
        vector(t, key);
        return;
    }
    type(t, "number");
    bounds(t, key);
}

/* A number or point, or a mapping from frames to these. */
static void curve(struct text *t, const struct job_key *key)
{
    json_array(t, "anyOf");
    json_object(t, NULL);
    number_or_vector(t, key);
    json_end_object(t);
    json_object(t, NULL);
    type(t, "object");
    json_object(t, "patternProperties");
    json_object(t, FRAME);
    number_or_vector(t, key);
    json_end_object(t);
    json_end_object(t);
    json_object(t, "properties");
    json_object(t, "ease");
    json_array(t, "enum");
    json_text(t, NULL, "linear");
    json_text(t, NULL, "smooth");
    json_text(t, NULL, "step");
    json_end_array(t);
    json_end_object(t);
    json_end_object(t);
    json_bool(t, "additionalProperties", false);
    json_end_object(t);
    json_end_array(t);
}

static void choices(struct text *t, const struct job_key *key)
{
    const char *item;
    size_t n;
    json_array(t, "enum");
    for (int i = 0; (item = choice_item(key->choices, i, &n)) != NULL; i++) {
        char word[64];
        snprintf(word, sizeof word, "%.*s", (int)n, item);
        json_text(t, NULL, word);
    }
    json_end_array(t);
}

/* A single frame may be written as a number. */
static void range(struct text *t)
{
    json_array(t, "type");
    json_text(t, NULL, "string");
    json_text(t, NULL, "integer");
    json_end_array(t);
    json_text(t, "pattern", RANGE);
}

static void items(struct text *t, const char *of)
{
    type(t, "array");
    json_object(t, "items");
    if (of)
        type(t, of);
    json_end_object(t);
}

static void value(struct text *t, const struct job_key *key)
{
    const char *child = key->child >= 0 ? job_sections[key->child].name : "";
    switch (key->type) {
    case KEY_TEXT:
        if (key->n) {
            json_array(t, "type");
            json_text(t, NULL, "string");
            json_text(t, NULL, "number");
            json_end_array(t);
            break;
        }
        type(t, "string");
        break;
    case KEY_INPUT:
        type(t, "string");
        break;
    case KEY_NAME:
        type(t, "string");
        json_text(t, "pattern", "^[A-Za-z0-9_-]{1,64}$");
        break;
    case KEY_NUM:
        type(t, "number");
        bounds(t, key);
        break;
    case KEY_INT:
        type(t, "integer");
        bounds(t, key);
        break;
    case KEY_BOOL:
        type(t, "boolean");
        break;
    case KEY_CHOICE:
        choices(t, key);
        break;
    case KEY_CURVE:
    case KEY_TRACK:
        curve(t, key);
        break;
    case KEY_VEC:
        vector(t, key);
        break;
    case KEY_RANGE:
        range(t);
        break;
    case KEY_RANGES:
        type(t, "array");
        json_object(t, "items");
        range(t);
        json_end_object(t);
        break;
    case KEY_POINTS:
        type(t, "array");
        json_object(t, "items");
        vector(t, key);
        json_end_object(t);
        break;
    case KEY_NAMES:
        items(t, "string");
        break;
    case KEY_TEXTS:
        items(t, NULL);
        break;
    case KEY_SUB:
    case KEY_MAYBE:
        reference(t, child);
        break;
    case KEY_LIST:
        type(t, "array");
        json_object(t, "items");
        reference(t, child);
        json_end_object(t);
        break;
    case KEY_MAP:
        type(t, "object");
        json_object(t, "additionalProperties");
        reference(t, child);
        json_end_object(t);
        break;
    case KEY_NODE:
        reference(t, "shape");
        break;
    case KEY_SETS:
        type(t, "object");
        break;
    }
}

/* Adds the description of a key, which is its meaning with the unit, and its default if that is a single name or number. */
static void property(struct text *t, const struct job_key *key)
{
    char meaning[1200];
    json_object(t, key->name);
    value(t, key);
    snprintf(meaning, sizeof meaning, "%s%s%s%s", key->meaning, *key->unit ? " [" : "", key->unit,
             *key->unit ? "]" : "");
    json_text(t, "description", meaning);
    if ((key->type == KEY_NUM || key->type == KEY_INT || key->type == KEY_CURVE) && !isnan(key->number))
        json_number(t, "default", key->number);
    else if (key->type == KEY_BOOL && !isnan(key->number))
        json_bool(t, "default", key->number != 0);
    else if (key->type == KEY_CHOICE && key->preset)
        json_text(t, "default", key->preset);
    json_end_object(t);
}

/* The names of items of a MAP are its keys. */
static bool is_name(const struct job_section *s, const struct job_key *key)
{
    return key->type == KEY_NAME && s != &job_sections[SECTION_job];
}

/* A mapping with a required key is itself required. */
static bool required(const struct job_key *key)
{
    if (key->type != KEY_SUB)
        return key_required(key);
    const struct job_section *child = &job_sections[key->child];
    for (size_t i = 0; i < child->n; i++)
        if (required(&child->key[i]))
            return true;
    return false;
}

static void section(struct text *t, const struct job_section *s)
{
    json_object(t, s->name);
    type(t, "object");
    json_text(t, "description", s->meaning);
    json_bool(t, "additionalProperties", false);
    json_object(t, "properties");
    for (size_t i = 0; i < s->n; i++)
        if (!is_name(s, &s->key[i]))
            property(t, &s->key[i]);
    json_end_object(t);
    json_array(t, "required");
    for (size_t i = 0; i < s->n; i++)
        if (!is_name(s, &s->key[i]) && required(&s->key[i]))
            json_text(t, NULL, s->key[i].name);
    json_end_array(t);
    json_end_object(t);
}

/* Exactly one shape, or an operator with its list and the keys of `group`. */
static void shape(struct text *t)
{
    const struct job_section *group = &job_sections[SECTION_group];
    json_object(t, "shape");
    json_array(t, "oneOf");
    for (int i = 0; i < SHAPES + (int)NODE_SHAPE; i++) {
        const char *name = i < SHAPES ? job_sections[i].name : node_operators[i - SHAPES];
        json_object(t, NULL);
        type(t, "object");
        json_object(t, "properties");
        json_object(t, name);
        if (i < SHAPES) {
            reference(t, name);
        } else {
            type(t, "array");
            json_integer(t, "minItems", 1);
            json_object(t, "items");
            reference(t, "shape");
            json_end_object(t);
        }
        json_end_object(t);
        for (size_t k = 0; i >= SHAPES && k < group->n; k++)
            property(t, &group->key[k]);
        json_end_object(t);
        json_array(t, "required");
        json_text(t, NULL, name);
        json_end_array(t);
        json_bool(t, "additionalProperties", false);
        json_end_object(t);
    }
    json_end_array(t);
    json_end_object(t);
}

status job_schema(struct text *t)
{
    json_object(t, NULL);
    json_text(t, "$schema", "https://json-schema.org/draft/2020-12/schema");
    json_text(t, "title", "a job of hoodoo");
    reference(t, job_sections[SECTION_job].name);
    json_object(t, "$defs");
    for (int i = 0; i < JOB_SECTIONS; i++)
        section(t, &job_sections[i]);
    shape(t);
    json_end_object(t);
    json_end_object(t);
    text_add(t, "\n");
    return text_status(t);
}
