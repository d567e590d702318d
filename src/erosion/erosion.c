#include "erosion/erosion.h"

#include <math.h>
#include <stdlib.h>

#include "base/memory.h"

uint64_t erosion_bytes(size_t n)
{
    return (uint64_t)n * 8;
}

status erosion_create(struct gpu *gpu, const struct job *job, size_t n_max, struct erosion *e)
{
    status st = OK;
    *e = (struct erosion){.n_layers = job->n_strata};
    TRY(gpu_buffer_create(gpu, "layers", e->n_layers, 16, &e->layers));
    TRY(gpu_buffer_create(gpu, "intensity", n_max, 4, &e->intensity));
    TRY(gpu_buffer_create(gpu, "intensity parts", n_max, 4, &e->parts));
done:
    if (st != OK)
        erosion_destroy(gpu, e);
    return st;
}

void erosion_destroy(struct gpu *gpu, struct erosion *e)
{
    gpu_buffer_destroy(gpu, &e->layers);
    gpu_buffer_destroy(gpu, &e->intensity);
    gpu_buffer_destroy(gpu, &e->parts);
}

/* By the plane face of unstressed rock of the weakest layer, across the wind. Edges, tension, noise and paint
 * make single spots faster; there max_step is exceeded, and the carry makes up for it. */
int erosion_steps(const struct job *job, int frame, double intensity)
{
    double weakest = 0;
    for (size_t i = 0; i < job->n_strata; i++)
        weakest = fmax(weakest, curve_at(&job->strata[i].weak_m_per_kyr, frame));
    double kyr = job->clock.years_per_frame / 1000;
    double share = weakest * intensity * kyr / job->domain.spacing_m;
    double steps = ceil(share / job->erosion.max_step);
    return steps < 1 ? 1 : steps > 1000 ? 1000 : (int)steps;
}

static status upload_layers(struct gpu *gpu, struct erosion *e, const struct job *job, int frame)
{
    status st = OK;
    float *layer = NULL;
    TRY(memory_alloc(e->n_layers, 16, "layers", &layer));
    for (size_t i = 0; i < e->n_layers; i++) {
        const struct job_layer *l = &job->strata[i];
        layer[4 * i + 0] = (float)curve_at(&l->weak_m_per_kyr, frame);
        layer[4 * i + 1] = (float)curve_at(&l->strong_m_per_kyr, frame);
        layer[4 * i + 2] = (float)(1e6 * curve_at(&l->interlock_MPa, frame));
    }
    TRY(gpu_upload(gpu, e->layers, 0, layer, e->n_layers));
done:
    free(layer);
    return st;
}

status erosion_interlock(struct gpu *gpu, struct erosion *e, const struct job *job, int frame,
                         struct particles *p)
{
    struct interlock_params k = {(uint)p->n, (float)job->rock.interlock_band};
    status st = OK;
    TRY(upload_layers(gpu, e, job, frame));
    GPU_RUN(gpu, erosion_interlock, p->n, k, e->layers, p->field[ROCK_layer], p->field[ROCK_rate_factor],
            p->field[ROCK_interlock_factor], p->field[ROCK_stress], p->field[ROCK_phase],
            p->field[ROCK_erodibility]);
done:
    return st;
}

status erosion_pace(struct gpu *gpu, struct gpu_work *work, struct erosion *e, struct particles *p,
                    double *m_per_kyr)
{
    status st = OK;
    float fastest = 0;
    struct count_params k = {(uint)p->n_surface};
    struct gpu_buffer *words = gpu_work_words(work);
    GPU_RUN(gpu, erosion_pace, k.n, k, p->surface, e->intensity, p->field[ROCK_erodibility], p->flags);
    gpu_max(gpu, work, p->flags, p->n_surface, words, COUNT_FASTEST);
    TRY(gpu_download(gpu, words, COUNT_FASTEST, &fastest, 1));
    *m_per_kyr = (double)fastest;
done:
    return st;
}

status erosion_weather(struct gpu *gpu, struct gpu_work *work, struct erosion *e, double kyr,
                       struct particles *p, struct budget *budget, uint32_t *n_eroded)
{
    status st = OK;
    struct erosion_params k = {
        .n = (uint)p->n_surface,
        .nx = (uint)p->voxels[0],
        .ny = (uint)p->voxels[1],
        .nz = (uint)p->voxels[2],
        .h = (float)p->h,
        .dt = (float)kyr,
        .walls = p->walls,
    };
    struct voxel_params carry = particles_params(p, p->n);
    struct gpu_buffer *counts = gpu_work_words(work);
    /* What is left of the step where a particle is gone, by what it went, and the quanta each process took. */
    struct gpu_buffer *unspent = p->flags, *shares = p->place, *spent = p->taken;
    gpu_fill(gpu, counts, 0);
    gpu_fill(gpu, unspent, 0);
    GPU_RUN(gpu, erosion_weather, p->n_surface, k, p->surface, p->field[ROCK_P], p->field[ROCK_N],
            e->intensity, p->field[ROCK_erodibility], p->held.words, p->field[ROCK_viability], unspent,
            counts, e->parts, spent, shares);
    budget_split(gpu, budget, spent, e->parts, p->n_surface);
    GPU_RUN(gpu, erosion_carry, p->n, carry, p->field[ROCK_P], p->field[ROCK_N], p->start,
            p->field[ROCK_erodibility], unspent, p->field[ROCK_viability], shares, spent, e->parts,
            p->held.words);
    budget_split(gpu, budget, spent, e->parts, p->n);
    TRY(gpu_download(gpu, counts, COUNT_ERODED, n_eroded, 1));
done:
    return st;
}
