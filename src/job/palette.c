#include "job/palette.h"

#include <string.h>

/* What loose material and water look like, unless the job says otherwise; then its own materials. */
static const struct {
    const char *name;
    float rgb[3];
} own_materials[] = {
    {"sand", {0.66f, 0.44f, 0.25f}}, {"rock", {0.40f, 0.27f, 0.19f}}, {"water", {0.03f, 0.09f, 0.10f}}};
enum { OWN = sizeof own_materials / sizeof *own_materials };

/* Is it one that every terrain has? */
static bool is_own(const char *name)
{
    bool found = strcmp(name, "bedrock") == 0;
    for (int i = 0; i < OWN; i++)
        found |= strcmp(name, own_materials[i].name) == 0;
    return found;
}

size_t palette_size(const struct job *job)
{
    size_t n = job->n_strata;
    if (!job_model(job)->terrain)
        return n;
    n += OWN;
    for (size_t i = 0; i < job->arches.n_materials; i++)
        n += !is_own(job->arches.materials[i].name);
    return n;
}

/* The job's material that the k-th after the strata is, or NULL if the job does not mention it. */
static const struct job_material *material_of(const struct job *job, size_t k)
{
    size_t further = OWN;
    for (size_t i = 0; i < job->arches.n_materials; i++) {
        const struct job_material *m = &job->arches.materials[i];
        if (k < OWN ? strcmp(m->name, own_materials[k].name) == 0 : !is_own(m->name) && further++ == k)
            return m;
    }
    return NULL;
}

void palette_color(const struct job *job, size_t layer, float rgb[3])
{
    /* Navajo buff, iron red, salmon, ochre, cream, rust: no two neighbours alike, and none far from the others. */
    static const float stone[][3] = {{0.53f, 0.31f, 0.18f}, {0.42f, 0.185f, 0.10f}, {0.58f, 0.33f, 0.205f},
                                     {0.55f, 0.36f, 0.21f}, {0.65f, 0.46f, 0.31f},  {0.37f, 0.17f, 0.10f}};
    static const double none[3] = {-1, -1, -1};
    const float *own = stone[layer % (sizeof stone / sizeof *stone)];
    const double *given = none;
    if (layer < job->n_strata) {
        given = job->strata[layer].color;
    } else {
        const struct job_material *m = material_of(job, layer - job->n_strata);
        if (layer - job->n_strata < OWN)
            own = own_materials[layer - job->n_strata].rgb;
        given = m ? m->color : none;
    }
    bool use = given[0] >= 0 && given[1] >= 0 && given[2] >= 0;
    for (int i = 0; i < 3; i++)
        rgb[i] = use ? (float)given[i] : own[i];
}
