#include "skin/skin.h"

#include <math.h>

/* Reach within which faces are searched: in depths (e^-3 is 5 %), and at most in voxels. */
static const double reach_depths = 3;
enum { REACH_MOST = 16 };

static struct skin_params params(const struct job *job, const struct particles *p)
{
    return (struct skin_params){
        .n = (uint)p->n_surface,
        .nx = (uint)p->voxels[0],
        .ny = (uint)p->voxels[1],
        .nz = (uint)p->voxels[2],
        .h = (float)p->h,
        .walls = p->walls,
        .depth = (float)job->skin.depth_m,
        .reach = (uint)fmin(ceil(reach_depths * job->skin.depth_m / p->h), REACH_MOST),
        .crust_kyr = (float)job->skin.crust_kyr,
        .crust = (float)job->skin.crust,
        .damp = (float)job->skin.damp,
        .radius = (float)job->skin.damp_m,
    };
}

uint64_t skin_bytes(size_t n)
{
    return 8 * (uint64_t)n;
}

status skin_create(struct gpu *gpu, size_t n_max, struct skin *s)
{
    status st = OK;
    TRY(gpu_buffer_create(gpu, "crust", n_max, 4, &s->crust));
    TRY(gpu_buffer_create(gpu, "damp", n_max, 4, &s->damp));
done:
    return st;
}

void skin_destroy(struct gpu *gpu, struct skin *s)
{
    gpu_buffer_destroy(gpu, &s->crust);
    gpu_buffer_destroy(gpu, &s->damp);
}

void skin_begin(struct gpu *gpu, const struct job *job, struct particles *p)
{
    struct skin_params k = params(job, p);
    k.kyr = (float)job->skin.before_kyr;
    GPU_RUN(gpu, skin_begin, k.n, k, p->surface, p->field[ROCK_phase], p->field[ROCK_exposed_kyr]);
}

void skin_find(struct gpu *gpu, struct skin *s, const struct job *job, struct particles *p)
{
    const struct skin_params k = params(job, p);
    struct gpu_buffer *found = p->place;
    GPU_RUN(gpu, skin_reach, k.n, k, p->surface, p->field[ROCK_P], p->field[ROCK_N], p->field[ROCK_phase],
            p->field[ROCK_viability], p->field[ROCK_exposed_kyr], p->start, p->held.words, found);
    particles_fill(gpu, p);
    GPU_RUN(gpu, skin_harden, k.n, k, p->surface, p->field[ROCK_P], p->field[ROCK_N], p->field[ROCK_phase],
            p->field[ROCK_viability], p->held.words, p->fill, found, p->field[ROCK_exposed_kyr], s->crust,
            s->damp, p->field[ROCK_erodibility]);
    const struct count_params all = {(uint)p->n};
    GPU_RUN(gpu, skin_cover, all.n, all, p->field[ROCK_exposed_kyr]);
}

void skin_age(struct gpu *gpu, const struct skin *s, const struct job *job, double kyr,
              struct gpu_buffer *intensity, struct particles *p)
{
    struct skin_params k = params(job, p);
    k.kyr = (float)kyr;
    GPU_RUN(gpu, skin_age, k.n, k, p->surface, p->field[ROCK_phase], p->field[ROCK_erodibility], s->damp,
            intensity, p->field[ROCK_exposed_kyr]);
}

void skin_forget(struct gpu *gpu, struct particles *p)
{
    const struct count_params k = {(uint)p->n};
    GPU_RUN(gpu, skin_forget, k.n, k, p->field[ROCK_viability], p->field[ROCK_exposed_kyr]);
}
