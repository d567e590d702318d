#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "job/parse.h"

static status default_section(enum job_section_id section, const struct yaml *map, const char *below,
                              void *base)
{
    const struct job_section *s = &job_sections[section];
    status st = OK;
    for (size_t i = 0; i < s->n && st == OK; i++) {
        char path[200];
        snprintf(path, sizeof path, "%s.%s", below, s->key[i].name);
        st = read_default(&s->key[i], map, path, base);
    }
    return st;
}

/* Parses a default given as text in the table, such as "[1, 0, 0]". */
static void default_vec(const struct job_key *key, double *out)
{
    const char *s = key->preset + 1;
    for (size_t i = 0; i < key->n; i++) {
        char *end;
        out[i] = strtod(s, &end);
        s = end + strspn(end, ", ");
    }
}

static int default_choice(const struct job_key *key)
{
    const char *item;
    size_t n;
    for (int i = 0; (item = choice_item(key->choices, i, &n)) != NULL; i++)
        if (strlen(key->preset) == n && memcmp(key->preset, item, n) == 0)
            return i;
    return 0;
}

status read_default(const struct job_key *key, const struct yaml *map, const char *below, void *base)
{
    void *member = key_member(key, base);
    struct curve *curve;
    status st;
    if (key_required(key))
        return yaml_fail(map, below, "missing (%s%s%s)", key->unit, key->unit[0] ? "; " : "", key->meaning);
    switch (key->type) {
    case KEY_TEXT:
    case KEY_NAME:
    case KEY_INPUT:
        return memory_strdup(key->preset, member);
    case KEY_NUM:
        *(double *)member = key->number;
        return OK;
    case KEY_INT:
        *(int64_t *)member = (int64_t)key->number;
        return OK;
    case KEY_BOOL:
        *(bool *)member = key->number != 0;
        return OK;
    case KEY_CURVE:
        curve = member;
        st = memory_alloc(2, sizeof *curve->frame, "a curve", &curve->frame);
        if (st != OK)
            return st;
        curve->value = curve->frame + 1;
        curve->value[0] = key->number;
        curve->n = 1;
        return OK;
    case KEY_TRACK:
        curve = member;
        st = memory_alloc(1 + key->n, sizeof *curve->frame, "a curve", &curve->frame);
        if (st != OK)
            return st;
        curve->value = curve->frame + 1;
        default_vec(key, curve->value);
        curve->n = 1;
        return OK;
    case KEY_CHOICE:
        *(int *)member = default_choice(key);
        return OK;
    case KEY_VEC:
        default_vec(key, member);
        return OK;
    case KEY_RANGE:
        return range_parse(key->preset, member);
    case KEY_SUB:
        return default_section((enum job_section_id)key->child, map, below, member);
    case KEY_LIST:
    case KEY_MAP:
    case KEY_POINTS:
    case KEY_NAMES:
    case KEY_TEXTS:
    case KEY_NODE:
    case KEY_MAYBE:
    case KEY_RANGES:
    case KEY_SETS:
        break; /* already zeroed */
    }
    return OK;
}

void read_default_clock(const struct yaml *root, struct job *job)
{
    if (job->clock.seconds_per_frame > 0 && !yaml_get(yaml_get(root, "clock"), "years_per_frame"))
        job->clock.years_per_frame = 0;
}

void read_default_sides(const struct yaml *root, struct job *job)
{
    const struct yaml *sides = yaml_get(yaml_get(root, "domain"), "sides");
    struct job_sides *s = &job->domain.sides;
    if (!job_model(job)->terrain)
        return;
    if (!sides || !yaml_get(sides, "x_min"))
        s->x_min = SIDE_X_MIN_WALL;
    if (!sides || !yaml_get(sides, "x_max"))
        s->x_max = SIDE_X_MAX_WALL;
    if (!sides || !yaml_get(sides, "y_min"))
        s->y_min = SIDE_Y_MIN_WALL;
    if (!sides || !yaml_get(sides, "y_max"))
        s->y_max = SIDE_Y_MAX_WALL;
}

void read_default_pivot(const struct yaml *root, struct job *job)
{
    struct job_attitude *a = &job->attitude;
    const bool turns = a->dip_deg != 0 || a->n_folds || a->n_unconformities || job->n_joints;
    for (int i = 0; i < 3 && turns && !yaml_get(yaml_get(root, "attitude"), "pivot_m"); i++)
        a->pivot_m[i] = job->domain.size_m[i] / 2;
}

status read_default_layer(const struct yaml *root, struct job *job)
{
    if (job->n_strata)
        return OK;
    free(job->strata); /* an empty list is allocated too */
    status st = memory_alloc(1, sizeof *job->strata, "a layer", &job->strata);
    if (st != OK)
        return st;
    job->n_strata = 1;
    return default_section(SECTION_layer, root, "strata", job->strata);
}
