/* A heap of deposits without a model: rock given by voxels, fragments dropped on it frame by frame, their ways
 * by tests/ref/routing_ref. */
#ifndef HOODOO_TESTS_HEAP_H
#define HOODOO_TESTS_HEAP_H

#include "check.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "../ref/routing_ref.h"
#include "base/random.h"
#include "deposit/deposit.h"

struct heap {
    struct gpu *gpu;
    struct gpu_work *work;
    struct deposit deposit;
    struct job job;
    int n[3];
    double h;
    struct rock rock; /* after the last frame */
    uint32_t next_id;
    int frame;
    uint64_t start, left, slid;
    struct deposit_counts last;
    uint32_t most_rounds;
    int unshifted;          /* keep the routing's grid where it is */
    struct routing_ref way; /* of the last frame */
};

static inline struct heap heap_begin(const int n[3], double h, double repose_deg)
{
    static double frame = 0, one = 1;
    struct heap p = {.n = {n[0], n[1], n[2]}, .h = h};
    p.job.seed = 7;
    p.job.deposition.repose_deg = repose_deg;
    p.job.deposition.bulking = 1;
    p.job.deposition.viability.n = 1;
    p.job.deposition.viability.frame = &frame;
    p.job.deposition.viability.value = &one;
    assert_ok(gpu_create(&(struct gpu_options){.device = "auto"}, &p.gpu));
    assert_ok(gpu_work_create(p.gpu, (size_t)n[0] * (size_t)n[1] * (size_t)n[2] + 2, &p.work));
    assert_ok(deposit_create(p.gpu, n, &p.deposit));
    return p;
}

static inline void heap_end(struct heap *p)
{
    rock_free(&p->rock);
    routing_ref_free(&p->way);
    deposit_destroy(p->gpu, &p->deposit);
    gpu_work_destroy(p->gpu, &p->work);
    gpu_destroy(&p->gpu);
}

/* Space for so many particles more; the first of them. */
static inline size_t heap_grow(struct heap *p, size_t more)
{
    struct rock all;
    size_t first = p->rock.n;
    assert_ok(rock_alloc(&all, first + more, STATE));
    for (int f = 0; f < ROCK_FIELDS; f++)
        if (all.field[f] && first)
            memcpy(all.field[f], p->rock.field[f], first * rock_field_size((enum rock_field)f));
    rock_free(&p->rock);
    p->rock = all;
    p->start += more;
    return first;
}

/* Particle i, new, in the middle of a voxel; its id. */
static inline uint32_t heap_set(struct heap *p, size_t i, int x, int y, int z)
{
    const int v[3] = {x, y, z};
    for (int a = 0; a < 3; a++)
        p->rock.P[4 * i + (size_t)a] = (float)((v[a] + 0.5) * p->h);
    p->rock.viability[i] = p->rock.rate_factor[i] = p->rock.interlock_factor[i] = 1;
    return p->rock.id[i] = p->next_id++;
}

/* Rock in all voxels of a box. */
static inline void heap_box(struct heap *p, const int low[3], const int high[3])
{
    size_t i =
        heap_grow(p, (size_t)(high[0] - low[0]) * (size_t)(high[1] - low[1]) * (size_t)(high[2] - low[2]));
    for (int z = low[2]; z < high[2]; z++)
        for (int y = low[1]; y < high[1]; y++)
            for (int x = low[0]; x < high[0]; x++)
                heap_set(p, i++, x, y, z);
}

/* A frame: the particles with the n ids given are fragments. In the air they are no part of the ground. What the
 * ledger says is checked. */
static inline void heap_step(struct heap *p, const uint32_t *ids, size_t n, int in_air)
{
    struct particles particles;
    struct deposit_routing routing;
    float *viability = malloc(p->rock.n * sizeof *viability);
    assert_ok(particles_create(p->gpu, p->work, &p->rock, STATE, p->n, p->h, &particles));
    rock_free(&p->rock);
    assert_ok(particles_download(p->gpu, &particles, STATE, &p->rock));
    struct rock ground = p->rock;
    ground.n = 0;
    ground.P = malloc(p->rock.n * 4 * sizeof *ground.P);
    for (size_t i = 0; i < p->rock.n; i++) {
        viability[i] = p->rock.viability[i];
        for (size_t j = 0; j < n; j++)
            if (p->rock.id[i] == ids[j])
                viability[i] = 0;
        if (!in_air || viability[i] > 0)
            memcpy(&ground.P[4 * ground.n++], &p->rock.P[4 * i], 4 * sizeof *ground.P);
    }
    routing_ref_free(&p->way);
    p->way = routing_ref(&ground, p->n, p->h, random_hash((uint32_t)p->job.seed, (uint32_t)++p->frame, 0, 99),
                         p->unshifted);
    const struct routing_ref way = p->way;
    free(ground.P);
    assert_ok(gpu_upload(p->gpu, particles.field[ROCK_viability], 0, viability, p->rock.n));
    size_t cells = (size_t)way.cells[0] * (size_t)way.cells[1] * (size_t)way.cells[2];
    memcpy(routing.cells, way.cells, sizeof routing.cells);
    memcpy(routing.shift, way.shift, sizeof routing.shift);
    assert_ok(gpu_buffer_create(p->gpu, "tag", cells, 4, &routing.tag));
    assert_ok(gpu_buffer_create(p->gpu, "receiver", cells, 4, &routing.receiver));
    assert_ok(gpu_upload(p->gpu, routing.tag, 0, way.tag, cells));
    assert_ok(gpu_upload(p->gpu, routing.receiver, 0, way.receiver, cells));
    assert_ok(deposit_land(p->gpu, p->work, &p->deposit, &p->job, p->frame, 0, &routing, &particles, true,
                           &p->last));
    assert_int_equal(p->last.fragments, p->last.landed + p->last.left + p->last.waiting);
    assert_ok(particles_index(p->gpu, p->work, &particles));
    p->left += p->last.left;
    p->slid += p->last.slid;
    p->most_rounds = p->last.rounds > p->most_rounds ? p->last.rounds : p->most_rounds;
    rock_free(&p->rock);
    assert_ok(particles_download(p->gpu, &particles, STATE, &p->rock));
    assert_int_equal(p->start, p->rock.n + p->left);
    gpu_buffer_destroy(p->gpu, &routing.tag);
    gpu_buffer_destroy(p->gpu, &routing.receiver);
    particles_destroy(p->gpu, &particles);
    free(viability);
}

/* The free voxel over the highest particle of each column, for nx ny columns; the caller's to free. */
static inline int *heap_heights(const struct heap *p)
{
    int *z = calloc((size_t)p->n[0] * (size_t)p->n[1], sizeof *z);
    for (size_t i = 0; i < p->rock.n; i++) {
        const float *P = &p->rock.P[4 * i];
        int x = (int)((double)P[0] / p->h), y = (int)((double)P[1] / p->h),
            top = (int)((double)P[2] / p->h) + 1;
        int *c = &z[y * p->n[0] + x];
        *c = top > *c ? top : *c;
    }
    return z;
}

#endif
