#include "erosion/erosion.h"

#include <math.h>
#include <stdlib.h>

#include "base/memory.h"
#include "geology/attitude.h"

uint64_t erosion_bytes(size_t n)
{
    return (uint64_t)n * 8;
}

status erosion_create(struct gpu *gpu, const struct job *job, size_t n_max, struct erosion *e)
{
    status st = OK;
    *e = (struct erosion){.n_layers = job->n_strata};
    TRY(gpu_buffer_create(gpu, "layers", 2 * e->n_layers, 16, &e->layers));
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

/* The count is for a plane face of unstressed rock. Where edges, tension, noise, paint or deposits make single spots faster,
 * the model cuts a step into parts. */
int erosion_steps(const struct job *job, double m_per_kyr)
{
    double kyr = job->clock.years_per_frame / 1000;
    double share = m_per_kyr * kyr / job->domain.spacing_m;
    double steps = ceil(share / job->erosion.max_step);
    return steps < 1 ? 1 : steps > 1000 ? 1000 : (int)steps;
}

static status upload_layers(struct gpu *gpu, struct erosion *e, const struct job *job, int frame)
{
    status st = OK;
    float *layer = NULL;
    TRY(memory_alloc(2 * e->n_layers, 16, "layers", &layer));
    for (size_t i = 0; i < e->n_layers; i++) {
        const struct job_layer *l = &job->strata[i];
        const struct curve *own[] = {&l->deflation, &l->abrasion, &l->water, &l->threshold_Pa};
        layer[8 * i + 0] = (float)job_weak(job, i, frame);
        layer[8 * i + 1] = (float)job_strong(job, i, frame);
        layer[8 * i + 2] = (float)(1e6 * job_interlock(job, i, frame));
        for (size_t k = 0; k < 4; k++)
            layer[8 * i + 4 + k] = (float)curve_at(own[k], frame);
    }
    TRY(gpu_upload(gpu, e->layers, 0, layer, 2 * e->n_layers));
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

void erosion_lead(struct gpu *gpu, struct erosion *e, const struct job *job, struct gpu_buffer *along,
                  struct particles *p)
{
    double bed[3];
    attitude_up(job, bed);
    const struct lead_params k = {.n = (uint)p->n_surface,
                                  .nx = (uint)p->voxels[0],
                                  .ny = (uint)p->voxels[1],
                                  .nz = (uint)p->voxels[2],
                                  .h = (float)p->h,
                                  .bed_x = (float)bed[0],
                                  .bed_y = (float)bed[1],
                                  .bed_z = (float)bed[2]};
    GPU_RUN(gpu, erosion_lead, k.n, k, p->surface, p->field[ROCK_P], p->field[ROCK_N], p->field[ROCK_phase],
            along, e->intensity);
}

bool erosion_has_aspect(const struct job *job)
{
    return job->aspect.rate != 1 || job->aspect.rate_per_100m != 1;
}

void erosion_aspect(struct gpu *gpu, struct erosion *e, const struct job *job, struct particles *p)
{
    const double azimuth = job->aspect.azimuth_deg * 3.14159265358979323846 / 180,
                 half = log(job->aspect.rate) / 2;
    const struct aspect_params k = {.n = (uint)p->n_surface,
                                    .x = (float)(half * cos(azimuth)),
                                    .y = (float)(half * sin(azimuth)),
                                    .per_m = (float)(log(job->aspect.rate_per_100m) / 100)};
    GPU_RUN(gpu, erosion_aspect, k.n, k, p->surface, p->field[ROCK_P], p->field[ROCK_N], p->field[ROCK_phase],
            e->intensity);
}

status erosion_pace(struct gpu *gpu, struct gpu_work *work, struct erosion *e, struct particles *p,
                    struct gpu_buffer *slopes, struct erosion_pace *out)
{
    status st = OK;
    float fastest[3] = {0};
    struct count_params k = {(uint)p->n_surface};
    struct gpu_buffer *words = gpu_work_words(work);
    GPU_RUN(gpu, erosion_pace, k.n, k, p->surface, e->intensity, p->field[ROCK_erodibility],
            p->field[ROCK_phase], e->parts, p->flags, p->place);
    gpu_max(gpu, work, p->flags, p->n_surface, words, COUNT_FASTEST_ROCK);
    gpu_max(gpu, work, p->place, p->n_surface, words, COUNT_FASTEST_LOOSE);
    gpu_max(gpu, work, slopes, p->n_surface, words, COUNT_FASTEST_SLOPE);
    TRY(gpu_download(gpu, words, COUNT_FASTEST_ROCK, fastest, 3));
    *out = (struct erosion_pace){(double)fastest[0], (double)fastest[1], (double)fastest[2]};
done:
    return st;
}

/* Adds to *beyond what this round would have eroded of rock that lies too deep for it, m3. scratch: float [n]. */
static status add_beyond(struct gpu *gpu, struct gpu_work *work, const struct particles *p,
                         struct gpu_buffer *unspent, struct gpu_buffer *scratch, double *beyond)
{
    status st = OK;
    const struct voxel_params k = particles_params(p, p->n);
    struct gpu_buffer *words = gpu_work_words(work);
    float sum;
    GPU_RUN(gpu, erosion_beyond, k.n, k, p->field[ROCK_P], unspent, p->field[ROCK_viability],
            p->field[ROCK_phase], p->start, p->held.words, p->field[ROCK_erodibility], scratch);
    gpu_sum(gpu, work, scratch, p->n, words, COUNT_FASTEST_ROCK);
    TRY(gpu_download(gpu, words, COUNT_FASTEST_ROCK, &sum, 1));
    *beyond += (double)sum * pow(p->h, 3);
done:
    return st;
}

/* Carries the rest of the step from particles that vanished to those behind them, in rounds, until no more vanish. Rock deeper
 * than NEAR_REACH layers need not have particles and is not eroded. */
static status carry(struct gpu *gpu, struct gpu_work *work, struct erosion *e, struct particles *p,
                    struct gpu_buffer *crust, struct budget *budget, uint32_t *n_eroded, double *beyond)
{
    status st = OK;
    struct carry_params k = {.n = (uint)p->n,
                             .nx = (uint)p->voxels[0],
                             .ny = (uint)p->voxels[1],
                             .nz = (uint)p->voxels[2],
                             .h = (float)p->h,
                             .walls = p->walls};
    struct gpu_buffer *counts = gpu_work_words(work), *shares = p->place, *spent = p->taken,
                      *unspent = p->flags, *next = e->intensity;
    for (uint32_t before = 0; *n_eroded > before; k.round++) {
        before = *n_eroded;
        if (k.round >= NEAR_REACH)
            TRY(add_beyond(gpu, work, p, unspent, next, beyond));
        gpu_fill(gpu, next, 0);
        if (crust)
            GPU_RUN(gpu, erosion_carry_exposed, k.n, k, p->field[ROCK_P], p->field[ROCK_N], p->start,
                    p->field[ROCK_erodibility], unspent, p->field[ROCK_viability], shares, spent, e->parts,
                    p->held.words, next, counts, p->field[ROCK_vegetation], p->field[ROCK_phase],
                    p->field[ROCK_exposed_kyr], crust);
        else
            GPU_RUN(gpu, erosion_carry, k.n, k, p->field[ROCK_P], p->field[ROCK_N], p->start,
                    p->field[ROCK_erodibility], unspent, p->field[ROCK_viability], shares, spent, e->parts,
                    p->held.words, next, counts, p->field[ROCK_vegetation], p->field[ROCK_phase]);
        budget_split(gpu, budget, spent, e->parts, p->n);
        TRY(gpu_download(gpu, counts, COUNT_ERODED, n_eroded, 1));
        struct gpu_buffer *swap = unspent;
        unspent = next;
        next = swap;
    }
done:
    return st;
}

status erosion_weather(struct gpu *gpu, struct gpu_work *work, struct erosion *e, double kyr,
                       struct particles *p, struct gpu_buffer *crust, struct budget *budget,
                       uint32_t *n_eroded, double *beyond)
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
    struct gpu_buffer *counts = gpu_work_words(work);
    /* By particle: rest of the step where it vanished, the processes' shares in that, and quanta removed. */
    struct gpu_buffer *unspent = p->flags, *shares = p->place, *spent = p->taken;
    gpu_fill(gpu, counts, 0);
    gpu_fill(gpu, unspent, 0);
    GPU_RUN(gpu, erosion_weather, p->n_surface, k, p->surface, p->field[ROCK_P], p->field[ROCK_N],
            e->intensity, p->field[ROCK_erodibility], p->held.words, p->field[ROCK_viability], unspent,
            counts, e->parts, spent, shares, p->field[ROCK_phase]);
    budget_split(gpu, budget, spent, e->parts, p->n_surface);
    TRY(gpu_download(gpu, counts, COUNT_ERODED, n_eroded, 1));
    if (*n_eroded > 0)
        TRY(carry(gpu, work, e, p, crust, budget, n_eroded, beyond));
done:
    return st;
}
