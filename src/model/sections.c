#include "model/sections.h"

#include <limits.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include "base/memory.h"
#include "scene/scene.h"

status section_add(struct checkpoint *c, const char *name, size_t item, size_t n, void **data)
{
    struct checkpoint_section *s = &c->section[c->n_sections];
    size_t length = strlen(name);
    memcpy(s->name, name, length < sizeof s->name ? length + 1 : sizeof s->name - 1);
    s->item = item;
    s->n = n;
    status st = memory_alloc(n, item, name, &s->data);
    if (st == OK)
        c->n_sections++;
    *data = s->data;
    return st;
}

/* ---- checks */

status section_refuse(const struct checkpoint *c, const char *section, size_t i, const char *format, ...)
{
    char what[512];
    va_list args;
    va_start(args, format);
    vsnprintf(what, sizeof what, format, args);
    va_end(args);
    return fail(E_CHECKPOINT, "the checkpoint of frame %d is damaged: section '%s': item %zu %s", c->frame,
                section, i, what);
}

/* The first item that is out of its range, or n. The comparison is written so that NaN is out of every range. */
#define FIRST_WRONG(type)                                                                                    \
    static size_t first_wrong_##type(const type *item, size_t n, const struct section_rule *r)               \
    {                                                                                                        \
        for (size_t i = 0; i < n; i += r->stride)                                                            \
            for (size_t k = 0; k < r->stride; k++)                                                           \
                if (!((double)item[i + k] >= r->range[k][0] && (double)item[i + k] <= r->range[k][1]))       \
                    return i + k;                                                                            \
        return n;                                                                                            \
    }
FIRST_WRONG(float)
FIRST_WRONG(uint32_t)
FIRST_WRONG(double)
FIRST_WRONG(int64_t)

static size_t first_wrong(const struct checkpoint_section *s, const struct section_rule *r)
{
    switch (r->kind) {
    case SECTION_FLOAT:
        return first_wrong_float(s->data, s->n, r);
    case SECTION_WORD:
        return first_wrong_uint32_t(s->data, s->n, r);
    case SECTION_DOUBLE:
        return first_wrong_double(s->data, s->n, r);
    default:
        return first_wrong_int64_t(s->data, s->n, r);
    }
}

static double value_of(const struct checkpoint_section *s, enum section_kind kind, size_t i)
{
    switch (kind) {
    case SECTION_FLOAT:
        return (double)((const float *)s->data)[i];
    case SECTION_WORD:
        return ((const uint32_t *)s->data)[i];
    case SECTION_DOUBLE:
        return ((const double *)s->data)[i];
    default:
        return (double)((const int64_t *)s->data)[i];
    }
}

status section_get(const struct checkpoint *c, const struct section_rule *rule, const void **data, size_t *n)
{
    const size_t item = rule->kind == SECTION_FLOAT || rule->kind == SECTION_WORD ? 4 : 8;
    const struct checkpoint_section *s = checkpoint_find(c, rule->name, item);
    const bool any = rule->n == SECTION_ANY;
    if (!s)
        return fail(E_CHECKPOINT, "the checkpoint of frame %d has no section '%s' of items of %zu bytes",
                    c->frame, rule->name, item);
    if (any ? s->n % rule->stride != 0 : s->n != rule->n)
        return fail(E_CHECKPOINT, "the checkpoint of frame %d is damaged: section '%s' has %zu items, %s %zu",
                    c->frame, rule->name, s->n, any ? "not a multiple of" : "not",
                    any ? rule->stride : rule->n);
    size_t i = first_wrong(s, rule);
    if (i < s->n) {
        const double *range = rule->range[i % rule->stride];
        return section_refuse(c, rule->name, i, "is %.9g, but must be %.9g to %.9g",
                              value_of(s, rule->kind, i), range[0], range[1]);
    }
    *data = s->data;
    if (n)
        *n = s->n;
    return OK;
}

void section_place(double range[4][2], const int voxels[3], double h)
{
    for (int a = 0; a < 4; a++) {
        range[a][0] = a < 3 ? -h : 0;
        range[a][1] = a < 3 ? (voxels[a] + 1) * h : 0;
    }
}

status section_check_ids(const struct checkpoint *c, const char *section, const uint32_t *id, size_t n,
                         uint64_t bound, struct idset *ids)
{
    status st = OK;
    for (size_t i = 0; i < n; i++) {
        bool added;
        if (id[i] >= bound)
            return section_refuse(c, section, i, "is %u, but all must be below %llu", (unsigned)id[i],
                                  (unsigned long long)bound);
        TRY(idset_add(ids, id[i], &added));
        if (!added)
            return section_refuse(c, section, i, "is %u, and so is another", (unsigned)id[i]);
    }
done:
    return st;
}

status section_get_ledger(const struct checkpoint *c, struct ledger *out)
{
    status st = OK;
    const struct section_rule rule = {
        "ledger", SECTION_INTEGER, sizeof *out / 8, 1, {{0, SECTION_COUNT_MAX}}};
    const void *data;
    TRY(section_get(c, &rule, &data, NULL));
    memcpy(out, data, sizeof *out);
    if (out->start != out->rock + out->deposit + out->fallen + out->left)
        st = fail(
            E_CHECKPOINT,
            "the checkpoint of frame %d is damaged: section 'ledger': start %llu is not the sum of rock %llu, deposit %llu, fallen %llu and left %llu",
            c->frame, (unsigned long long)out->start, (unsigned long long)out->rock,
            (unsigned long long)out->deposit, (unsigned long long)out->fallen, (unsigned long long)out->left);
done:
    return st;
}

/* ---- sections of all models */

enum { DOMAIN_MODEL, DOMAIN_VOXELS, DOMAIN_SPACING = DOMAIN_VOXELS + 3, DOMAIN_STRATA, DOMAIN_NUMBERS };

static status domain_numbers(const struct job *job, double out[DOMAIN_NUMBERS])
{
    status st = OK;
    int voxels[3];
    TRY(scene_voxels(job, voxels));
    out[DOMAIN_MODEL] = job->model;
    for (int a = 0; a < 3; a++)
        out[DOMAIN_VOXELS + a] = voxels[a];
    out[DOMAIN_SPACING] = job->domain.spacing_m;
    out[DOMAIN_STRATA] = (double)job->n_strata;
done:
    return st;
}

status section_add_domain(struct checkpoint *c, const struct job *job)
{
    status st = OK;
    void *data;
    TRY(section_add(c, "domain", 8, DOMAIN_NUMBERS, &data));
    TRY(domain_numbers(job, data));
done:
    return st;
}

static const struct section_rule domain_rule = {
    "domain", SECTION_DOUBLE, DOMAIN_NUMBERS, 1, {{0, SECTION_COUNT_MAX}}};

status section_get_spacing(const struct checkpoint *c, int voxels[3], double *h)
{
    status st = OK;
    const void *data;
    TRY(section_get(c, &domain_rule, &data, NULL));
    const double *number = data;
    for (int a = 0; a < 3; a++)
        voxels[a] = (int)fmin(number[DOMAIN_VOXELS + a], INT_MAX);
    *h = number[DOMAIN_SPACING];
done:
    return st;
}

status section_check_domain(const struct checkpoint *c, const struct job *job)
{
    status st = OK;
    const void *data;
    double here[DOMAIN_NUMBERS];
    TRY(section_get(c, &domain_rule, &data, NULL));
    TRY(domain_numbers(job, here));
    const double *there = data;
    if (there[DOMAIN_MODEL] != here[DOMAIN_MODEL])
        return fail(E_CHECKPOINT, "the checkpoint of frame %d belongs to another model than the job's",
                    c->frame);
    if (memcmp(there + DOMAIN_VOXELS, here + DOMAIN_VOXELS, 4 * sizeof *here) != 0)
        return fail(
            E_CHECKPOINT,
            "the checkpoint of frame %d has %.0f x %.0f x %.0f voxels of %g m, but this job's domain has %.0f x %.0f x %.0f of %g m; give the job the same domain",
            c->frame, there[1], there[2], there[3], there[DOMAIN_SPACING], here[1], here[2], here[3],
            here[DOMAIN_SPACING]);
    if (there[DOMAIN_STRATA] != here[DOMAIN_STRATA])
        return fail(
            E_CHECKPOINT,
            "the checkpoint of frame %d has %.0f strata, but this job has %.0f; give the job the same number",
            c->frame, there[DOMAIN_STRATA], here[DOMAIN_STRATA]);
done:
    return st;
}
