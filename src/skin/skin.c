#include "skin/skin.h"

#include <math.h>

/* Beyond so many depths a face does not count: e^-3 is 5 %. And beyond so many voxels it is not looked for. */
static const double reach_depths = 3;
enum { REACH_MOST = 16 };

static struct skin_params params(const struct job *job, const struct particles *p, double kyr)
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
        .kyr = (float)kyr,
    };
}

void skin_begin(struct gpu *gpu, const struct job *job, struct particles *p)
{
    const struct skin_params k = params(job, p, job->skin.before_kyr);
    GPU_RUN(gpu, skin_begin, k.n, k, p->surface, p->field[ROCK_phase], p->field[ROCK_exposed_kyr]);
}

void skin_find(struct gpu *gpu, const struct job *job, struct particles *p)
{
    const struct skin_params k = params(job, p, 0);
    struct gpu_buffer *found = p->place;
    GPU_RUN(gpu, skin_reach, k.n, k, p->surface, p->field[ROCK_P], p->field[ROCK_N], p->field[ROCK_phase],
            p->field[ROCK_viability], p->field[ROCK_exposed_kyr], p->start, p->held.words, found);
    GPU_RUN(gpu, skin_take, k.n, k, p->surface, found, p->field[ROCK_exposed_kyr]);
}

void skin_age(struct gpu *gpu, const struct job *job, double kyr, struct gpu_buffer *intensity,
              struct particles *p)
{
    const struct skin_params k = params(job, p, kyr);
    GPU_RUN(gpu, skin_age, k.n, k, p->surface, p->field[ROCK_phase], p->field[ROCK_erodibility], intensity,
            p->field[ROCK_exposed_kyr]);
}

void skin_forget(struct gpu *gpu, struct particles *p)
{
    const struct count_params k = {(uint)p->n};
    GPU_RUN(gpu, skin_forget, k.n, k, p->field[ROCK_viability], p->field[ROCK_exposed_kyr]);
}
