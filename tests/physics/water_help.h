/* Beds of particles from a function of the voxel, and jobs with rain, for tests of water. Include check.h
 * first. */
#ifndef HOODOO_TESTS_WATER_HELP_H
#define HOODOO_TESTS_WATER_HELP_H

#include <stdlib.h>
#include <string.h>

#include "base/random.h"
#include "gpu/gpu.h"
#include "gpu/primitives.h"
#include "particles/particles.h"
#include "water/water.h"

struct scene {
    int n[3]; /* voxels */
    uint32_t seed;
};

/* The share of voxel (i, j, k) that is rock; 0: no particle. */
typedef float scene_fill(const struct scene *s, int i, int j, int k);

struct bed {
    struct gpu *gpu;
    struct gpu_work *work;
    struct particles p;
    struct rock rock; /* as on the device, in its order */
    int n[3];
    double h;
};

static inline double unit(uint32_t seed, uint32_t what)
{
    return (double)random_float(random_hash(seed, what, 0, 99));
}

static inline struct gpu *open_gpu(void)
{
    struct gpu *gpu = NULL;
    assert_ok(gpu_create(&(struct gpu_options){.device = "auto"}, &gpu));
    return gpu;
}

static inline struct bed bed_of(struct gpu *gpu, const struct scene *s, double h, scene_fill *fill)
{
    struct bed bed = {.gpu = gpu, .n = {s->n[0], s->n[1], s->n[2]}, .h = h};
    size_t voxels = (size_t)s->n[0] * (size_t)s->n[1] * (size_t)s->n[2];
    struct rock rock;
    assert_ok(rock_alloc(&rock, voxels, STATE));
    rock.n = 0;
    for (int k = 0; k < s->n[2]; k++)
        for (int j = 0; j < s->n[1]; j++)
            for (int i = 0; i < s->n[0]; i++) {
                float share = fill(s, i, j, k);
                int v[3] = {i, j, k};
                if (!(share > 0))
                    continue;
                for (size_t a = 0; a < 3; a++)
                    rock.P[4 * rock.n + a] =
                        (float)(h * (v[a] + 0.25 + 0.5 * unit((uint32_t)rock.n, (uint32_t)a)));
                rock.id[rock.n] = (uint32_t)rock.n;
                rock.viability[rock.n] = share;
                rock.rate_factor[rock.n] = 1;
                rock.interlock_factor[rock.n] = 1;
                rock.n++;
            }
    if (rock.n == 0) { /* particles cannot be none: one in a corner */
        rock.P[0] = rock.P[1] = rock.P[2] = (float)(h / 2);
        rock.viability[0] = 1;
        rock.n = 1;
    }
    assert_ok(gpu_work_create(gpu, voxels + 2, &bed.work));
    assert_ok(particles_create(gpu, bed.work, &rock, STATE, bed.n, h, &bed.p));
    rock_free(&rock);
    assert_ok(particles_surface(gpu, bed.work, &bed.p));
    assert_ok(particles_download(gpu, &bed.p, DERIVED, &bed.rock));
    return bed;
}

static inline void bed_free(struct bed *bed)
{
    particles_destroy(bed->gpu, &bed->p);
    gpu_work_destroy(bed->gpu, &bed->work);
    rock_free(&bed->rock);
}

/* A job with nothing but rain, *m_per_yr of it; `m_per_yr` must outlive it. */
static inline void job_of_rain(struct job *job, double *m_per_yr)
{
    static double frame = 1;
    memset(job, 0, sizeof *job);
    job->rain.m_per_yr = (struct curve){.n = 1, .frame = &frame, .value = m_per_yr};
}

#endif
