#include "shape/terrain.h"

#include <math.h>
#include <stdlib.h>

#include "base/memory.h"
#include "stacks/file.h"
#include "stacks/surface.h"

struct terrain_shape {
    struct stacks stacks;
    uint32_t solid; /* set of materials that are rock, a bit each */
    struct surface surface, far;
    double size[3];
};

/* The slope of the field f is at most sqrt(2) / sigma per metre: the plane section of a box of half-width sigma has at most sqrt(2) times
 * the area of a face. Where the box is completely full or empty, the surface is at least sigma away. */
#define STEEPEST 1.41422

status terrain_shape_create(const struct job_stacks *job, double reach, struct terrain_shape **out)
{
    status st = OK;
    struct terrain_shape *t = NULL;
    TRY(memory_alloc(1, sizeof *t, "terrain", &t));
    TRY(stacks_read(job->file, &t->stacks, &t->solid));
    double cell = t->stacks.cell;
    uint32_t set = UINT32_MAX & ~(1u << MATERIAL_AIR | 1u << MATERIAL_WATER);
    t->surface = (struct surface){&t->stacks, set, job->sigma * cell};
    t->far = (struct surface){&t->stacks, set, fmin(fmax(reach, t->surface.sigma), SURFACE_WIDEST * cell)};
    for (int a = 0; a < 2; a++)
        t->size[a] = t->stacks.n[a] * cell;
    t->size[2] = STACK_TOP * t->stacks.quantum;
    *out = t;
    t = NULL;
done:
    terrain_shape_destroy(&t);
    return st;
}

void terrain_shape_destroy(struct terrain_shape **t)
{
    if (*t)
        stacks_destroy(&(*t)->stacks);
    free(*t);
    *t = NULL;
}

void terrain_shape_size(const struct terrain_shape *t, double size[3])
{
    for (int a = 0; a < 3; a++)
        size[a] = t->size[a];
}

double terrain_shape_distance(const struct terrain_shape *t, const double x[3])
{
    double f = surface_at(&t->surface, x), d = -f * t->surface.sigma / STEEPEST, outside = -HUGE_VAL;
    if (fabs(f) > 1 - 1e-9) {
        double far = surface_at(&t->far, x);
        d = fabs(far) > 1 - 1e-9 ? -far * t->far.sigma : d;
    }
    for (int a = 0; a < 3; a++)
        outside = fmax(outside, fmax(-x[a], x[a] - t->size[a]));
    return fmax(d, outside);
}

bool terrain_shape_loose(const struct terrain_shape *t, const double x[3])
{
    size_t n;
    const struct stacks *s = &t->stacks;
    int i = (int)fmin(fmax(x[0] / s->cell, 0), s->n[0] - 1),
        j = (int)fmin(fmax(x[1] / s->cell, 0), s->n[1] - 1);
    const uint32_t *layer = stacks_column(s, i, j, &n);
    uint32_t z = stacks_quanta(s, x[2]), at = MATERIAL_AIR;
    for (size_t k = 0; k < n && (k == 0 || layer_top(layer[k - 1]) <= z); k++)
        if (layer_material(layer[k]) != MATERIAL_AIR && layer_material(layer[k]) != MATERIAL_WATER)
            at = layer_material(layer[k]);
    return at != MATERIAL_AIR && !(t->solid >> at & 1);
}
