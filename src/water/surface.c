/* Discharge, erosion and sweeping on the particles of the surface. */
#include "water/internal.h"

static struct water_surface_params surface_params(const struct water *w, const struct particles *p)
{
    return (struct water_surface_params){.n = (uint)p->n_surface,
                                         .nx = (uint)w->voxels[0],
                                         .ny = (uint)w->voxels[1],
                                         .nz = (uint)w->voxels[2],
                                         .h = (float)p->h,
                                         .words = (uint)w->words,
                                         .walls = w->walls};
}

void water_show(struct gpu *gpu, struct water *w, struct particles *p)
{
    struct water_surface_params k = surface_params(w, p);
    gpu_fill(gpu, p->field[ROCK_discharge], 0);
    GPU_RUN(gpu, water_show, p->n_surface, k, p->surface, p->field[ROCK_P], w->occupied, w->floors, w->first,
            w->node[WATER_CELL], w->pull, p->field[ROCK_discharge]);
}

void water_sweep(struct gpu *gpu, struct water *w, const struct job *job, struct particles *p,
                 struct fragments *fragments)
{
    const struct water *routing = &fragments->routing;
    struct water_surface_params k = surface_params(w, p);
    k.size = (uint)routing->size;
    k.sx = (uint)routing->shift[0];
    k.sy = (uint)routing->shift[1];
    k.sz = (uint)routing->shift[2];
    k.cx = (uint)routing->cells[0];
    k.cy = (uint)routing->cells[1];
    k.carry = (float)job->deposition.carry_Pa;
    GPU_RUN(gpu, water_sweep, p->n_surface, k, p->surface, p->field[ROCK_P], w->occupied, w->floors, w->first,
            w->pull, routing->tag);
}

void water_erode(struct gpu *gpu, struct water *w, const struct job *job, int frame, struct particles *p,
                 struct gpu_buffer *layers, struct gpu_buffer *intensity, struct gpu_buffer *parts,
                 struct gpu_buffer *slopes)
{
    struct water_surface_params k = surface_params(w, p);
    k.rate = (float)curve_at(&job->rain.erosion, frame);
    k.threshold = (float)curve_at(&job->rain.threshold_Pa, frame);
    k.carry = (float)job->deposition.carry_Pa;
    GPU_RUN(gpu, water_erode, p->n_surface, k, p->surface, p->field[ROCK_P], p->field[ROCK_N], w->occupied,
            w->floors, w->first, w->pull, p->field[ROCK_erodibility], p->field[ROCK_layer], layers, intensity,
            parts, w->node[WATER_DROP], slopes, p->field[ROCK_phase]);
}
