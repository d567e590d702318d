#include "plants/plants.h"

#include <math.h>

#include "base/random.h"

/* Voxels that cover may advance in a frame; a faster spread_m_per_kyr is cut off at this. */
enum { SPREAD_MOST = 64 };

bool plants_wanted(const struct job *job)
{
    for (size_t i = 0; i < job->n_paint; i++)
        if (job->paint[i].vegetation > 0)
            return true;
    return false;
}

static struct plants_params params(const struct job *job, const struct particles *p, size_t n)
{
    return (struct plants_params){
        .n = (uint)n,
        .nx = (uint)p->voxels[0],
        .ny = (uint)p->voxels[1],
        .nz = (uint)p->voxels[2],
        .h = (float)p->h,
        .steepest = (float)cos(job->vegetation.steepest_deg * 3.14159265358979323846 / 180),
        .binding = (float)job->vegetation.binding,
        .shelter = (float)job->vegetation.shelter,
        .walls = p->walls,
    };
}

void plants_shield(struct gpu *gpu, const struct job *job, struct particles *p, struct gpu_buffer *intensity)
{
    struct plants_params k = params(job, p, p->n_surface);
    GPU_RUN(gpu, plants_shield, k.n, k, p->surface, p->field[ROCK_vegetation], intensity);
}

void plants_bind(struct gpu *gpu, const struct job *job, struct particles *p)
{
    struct plants_params k = params(job, p, p->n);
    GPU_RUN(gpu, plants_root, k.n, k, p->field[ROCK_N], p->field[ROCK_vegetation]);
    k.n = (uint)p->n_surface;
    GPU_RUN(gpu, plants_bind, k.n, k, p->surface, p->field[ROCK_vegetation], p->field[ROCK_erodibility]);
}

/* Whole voxels that cover advances in this frame. Computed from the frame's number instead of an accumulated remainder, so that
 * frames add up to the distance without any state. */
static int spread_steps(const struct job *job, int frame, double h)
{
    double per_frame = job->vegetation.spread_m_per_kyr * job->clock.years_per_frame / 1000 / h;
    double steps = floor(frame * per_frame) - floor((frame - 1) * per_frame);
    return steps > SPREAD_MOST ? SPREAD_MOST : (int)steps;
}

static void seed(struct gpu *gpu, const struct job *job, double kyr, struct plants_params k,
                 struct particles *p)
{
    k.seeds = (float)job->vegetation.seeds_m;
    k.chance = (float)-expm1(-job->vegetation.seeds_per_m2_kyr * p->h * p->h * kyr);
    if (k.seeds <= 0 || k.chance <= 0)
        return;
    gpu_copy(gpu, p->place, p->field[ROCK_vegetation], p->n);
    GPU_RUN(gpu, plants_seed, k.n, k, p->surface, p->field[ROCK_P], p->field[ROCK_phase], p->start, p->place,
            p->field[ROCK_id], p->field[ROCK_vegetation], p->held.words);
}

void plants_grow(struct gpu *gpu, const struct job *job, int frame, struct particles *p)
{
    double kyr = job->clock.years_per_frame / 1000;
    double growth = curve_at(&job->vegetation.growth_per_kyr, frame);
    struct plants_params k = params(job, p, p->n_surface);
    k.seed = random_hash((uint32_t)job->seed, (uint32_t)frame, 0, RANDOM_PLANTS);
    k.growth = (float)exp(fmin(growth * kyr, 50));
    k.death = (float)exp(-job->vegetation.death_per_kyr * kyr);
    GPU_RUN(gpu, plants_live, k.n, k, p->surface, p->field[ROCK_P], p->field[ROCK_phase], p->held.words,
            p->field[ROCK_vegetation]);
    if (growth <= 0)
        return;
    seed(gpu, job, kyr, k, p);
    for (int s = spread_steps(job, frame, p->h); s > 0; s--) {
        k.spread = (uint)s;
        gpu_copy(gpu, p->place, p->field[ROCK_vegetation], p->n);
        GPU_RUN(gpu, plants_spread, k.n, k, p->surface, p->field[ROCK_P], p->field[ROCK_phase], p->start,
                p->place, p->field[ROCK_id], p->field[ROCK_vegetation], p->held.words);
    }
}
