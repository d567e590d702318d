#include "scene/paint.h"

#include <math.h>
#include <stdlib.h>

#include "base/memory.h"
#include "scene/scene.h"

struct paint_set {
    size_t n;
    const struct job_paint *entry;
    struct solid **shape;
};

status paint_create(const struct job *job, struct paint_set **out)
{
    status st = OK;
    struct paint_set *set = NULL;
    double h = job->domain.spacing_m;
    TRY(memory_alloc(1, sizeof *set, "paint", &set));
    set->entry = job->paint;
    TRY(memory_alloc(job->n_paint, sizeof *set->shape, "paint", &set->shape));
    for (; set->n < job->n_paint; set->n++)
        TRY(solid_create(job->paint[set->n].shape, h / 2, job->paint[set->n].falloff_m + h,
                         &set->shape[set->n]));
    *out = set;
    set = NULL;
done:
    paint_destroy(&set);
    return st;
}

void paint_destroy(struct paint_set **set)
{
    if (!*set)
        return;
    for (size_t i = 0; i < (*set)->n; i++)
        solid_destroy(&(*set)->shape[i]);
    free((*set)->shape);
    free(*set);
    *set = NULL;
}

/* 1 inside, down to 0 over the falloff outside (smoothstep). */
static double cover(double distance, double falloff)
{
    if (distance <= 0)
        return 1;
    if (distance >= falloff)
        return 0;
    double t = 1 - distance / falloff;
    return t * t * (3 - 2 * t);
}

/* A factor of 1, the default, leaves what other entries painted. */
static double over(double below, double factor, double w)
{
    return factor == 1 ? below : below + w * (factor - below);
}

struct paint_values paint_at(const struct paint_set *set, const double x[3])
{
    struct paint_values v = {1, 1, 1, 0};
    for (size_t i = 0; i < set->n; i++) {
        const struct job_paint *e = &set->entry[i];
        struct solid_point p = solid_at(set->shape[i], x);
        double w = cover(p.distance, e->falloff_m);
        if (w == 0)
            continue;
        v.erodibility = over(v.erodibility, e->erodibility, w);
        v.interlock = over(v.interlock, e->interlock, w);
        v.viability = over(v.viability, e->viability, w);
        v.inert |= p.distance <= 0 && (e->inert || p.inert);
    }
    return v;
}
