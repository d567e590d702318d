#include "scene/paint.h"

#include <math.h>
#include <stdlib.h>

#include "base/memory.h"
#include "base/random.h"
#include "scene/projection.h"
#include "scene/scene.h"
#include "scene/vertex_paint.h"
#include "shape/noise.h"

/* The mask of one entry. */
struct mask {
    struct solid *shape;           /* or NULL */
    struct projection *image;      /* or NULL */
    struct vertex_paint *vertices; /* or NULL */
    struct noise noise;
};

struct paint_set {
    size_t n;
    const struct job_paint *entry;
    struct mask *mask;
};

static status mask_create(const struct job *job, const struct job_paint *e, struct mask *out)
{
    status st = OK;
    double h = job->domain.spacing_m;
    if (e->shape)
        TRY(solid_create(e->shape, h / 2, e->falloff_m + h, &out->shape));
    if (e->image)
        TRY(projection_create(e->image, h, &out->image));
    if (e->mesh_attribute)
        TRY(vertex_paint_create(e->mesh_attribute, &out->vertices));
    if (e->noise) {
        const struct job_noise noise = {
            .scale_m = e->noise->scale_m, .octaves = e->noise->octaves, .flatten = e->noise->flatten};
        uint32_t seed = random_hash((uint32_t)job->seed, (uint32_t)e->noise->seed, 0, RANDOM_PAINT);
        out->noise = noise_init(&noise, seed);
    }
done:
    return st;
}

status paint_create(const struct job *job, const struct job_paint *entry, size_t n, struct paint_set **out)
{
    status st = OK;
    struct paint_set *set = NULL;
    TRY(memory_alloc(1, sizeof *set, "paint", &set));
    set->entry = entry;
    TRY(memory_alloc(n, sizeof *set->mask, "paint", &set->mask));
    for (size_t i = 0; i < n; i++) {
        set->n++;
        TRY(mask_create(job, &entry[i], &set->mask[i]));
    }
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
    for (size_t i = 0; i < (*set)->n; i++) {
        solid_destroy(&(*set)->mask[i].shape);
        projection_destroy(&(*set)->mask[i].image);
        vertex_paint_destroy(&(*set)->mask[i].vertices);
    }
    free((*set)->mask);
    free(*set);
    *set = NULL;
}

bool paint_needs_occluders(const struct paint_set *set)
{
    for (size_t i = 0; i < set->n; i++)
        if (set->mask[i].image && projection_needs_occluders(set->mask[i].image))
            return true;
    return false;
}

void paint_add_occluder(struct paint_set *set, const double x[3])
{
    for (size_t i = 0; i < set->n; i++)
        if (set->mask[i].image)
            projection_add_occluder(set->mask[i].image, x);
}

static double smoothstep(double t)
{
    t = fmin(fmax(t, 0), 1);
    return t * t * (3 - 2 * t);
}

/* 1 inside the shape, falling smoothly to 0 at the distance `falloff`. */
static double edge_weight(double distance, double falloff)
{
    if (distance <= 0)
        return 1;
    return distance < falloff ? smoothstep(1 - distance / falloff) : 0;
}

static double noise_weight(const struct job_mask *m, const struct noise *noise, const double x[3])
{
    double above = noise_at(noise, x) - m->threshold;
    return m->soft > 0 ? smoothstep(above / m->soft + 0.5) : above >= 0;
}

/* Blends `factor` over `below`. A factor of 1, the default, keeps what other entries painted. */
static double blend(double below, double factor, double w)
{
    return factor == 1 ? below : below + w * (factor - below);
}

struct paint_values paint_at(const struct paint_set *set, const double x[3], double vegetation)
{
    struct paint_values v = {1, 1, 1, vegetation, 0};
    for (size_t i = 0; i < set->n; i++) {
        const struct job_paint *e = &set->entry[i];
        const struct mask *mask = &set->mask[i];
        struct solid_point p = e->shape ? solid_at(mask->shape, x) : (struct solid_point){0};
        double w = edge_weight(p.distance, e->falloff_m);
        if (w > 0 && e->image)
            w *= projection_at(mask->image, x);
        if (w > 0 && e->mesh_attribute)
            w *= vertex_paint_at(mask->vertices, x);
        if (w > 0 && e->noise)
            w *= noise_weight(e->noise, &mask->noise, x);
        if (w == 0)
            continue;
        v.erodibility = blend(v.erodibility, e->erodibility, w);
        v.interlock = blend(v.interlock, e->interlock, w);
        v.viability = blend(v.viability, e->viability, w);
        if (e->vegetation >= 0)
            v.vegetation += w * (e->vegetation - v.vegetation);
        v.inert |= p.distance <= 0 && w >= 0.5 && (e->inert || p.inert);
    }
    return v;
}
