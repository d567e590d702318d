/* Air around a rock given by a function, without a model: the flow of a job's wind section. */
#ifndef HOODOO_TESTS_WIND_HELP_H
#define HOODOO_TESTS_WIND_HELP_H

#include "check.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "wind/flow.h"
#include "wind/wind.h"

typedef int rock_at(const double x[3]); /* m: is there rock? */

struct tunnel {
    struct gpu *gpu;
    struct job *job;
    struct gpu_work *work;
    int voxels[3];
    struct particles particles;
};

/* Rock in voxels of h m of a domain, full where `inside` says so for their middles. */
static inline void tunnel_rock(struct tunnel *t, rock_at *inside, double h)
{
    size_t n = 0;
    struct rock rock;
    for (int pass = 0; pass < 2; pass++) {
        if (pass == 1) {
            assert_ok(rock_alloc(&rock, n ? n : 1, STATE));
            n = 0;
        }
        for (int z = 0; z < t->voxels[2]; z++)
            for (int y = 0; y < t->voxels[1]; y++)
                for (int x = 0; x < t->voxels[0]; x++) {
                    const double at[3] = {(x + 0.5) * h, (y + 0.5) * h, (z + 0.5) * h};
                    if (!inside(at))
                        continue;
                    if (pass == 1) {
                        for (int a = 0; a < 3; a++)
                            rock.P[4 * n + (size_t)a] = (float)at[a];
                        rock.id[n] = (uint32_t)n;
                        rock.viability[n] = 1;
                    }
                    n++;
                }
    }
    assert_ok(particles_create(t->gpu, t->work, &rock, STATE, t->voxels, h, &t->particles));
    assert_ok(particles_surface(t->gpu, t->work, &t->particles));
    rock_free(&rock);
}

/* A domain of `size` m with voxels of h, air of `spacing`; `wind` goes into the job's wind section. */
static inline struct tunnel tunnel_open(const int size[3], double h, const char *wind, rock_at *inside)
{
    char path[] = "/tmp/hoodoo-job.XXXXXX";
    struct tunnel t = {0};
    int file = mkstemp(path);
    assert_true(file >= 0);
    FILE *f = fdopen(file, "w");
    assert_non_null(f);
    fprintf(f,
            "hoodoo: 1\nname: tunnel\nframes: 1-10\nclock: {years_per_frame: 1000}\n"
            "domain: {size_m: [%d, %d, %d], spacing_m: %g}\n"
            "scene: {box: {min_m: [0, 0, 0], max_m: [1, 1, 1]}}\n"
            "strata: [{weak_m_per_kyr: 0.1, strong_m_per_kyr: 0.001}]\n"
            "wind: %s\n",
            size[0], size[1], size[2], h, wind);
    assert_int_equal(fclose(f), 0);
    assert_ok(job_load(path, NULL, 0, &t.job));
    unlink(path);
    assert_ok(gpu_create(&(struct gpu_options){.device = "auto"}, &t.gpu));
    size_t n = 1;
    for (int a = 0; a < 3; a++) {
        t.voxels[a] = (int)lround(size[a] / h);
        n *= (size_t)t.voxels[a];
    }
    assert_ok(gpu_work_create(t.gpu, n + 2, &t.work));
    tunnel_rock(&t, inside, h);
    return t;
}

static inline void tunnel_close(struct tunnel *t)
{
    particles_destroy(t->gpu, &t->particles);
    gpu_work_destroy(t->gpu, &t->work);
    gpu_destroy(&t->gpu);
    job_destroy(&t->job);
}

/* The averaged wind, box cells of 4 floats. */
static inline float *tunnel_mean(struct tunnel *t, const struct flow *f)
{
    size_t n = (size_t)f->box[0] * (size_t)f->box[1] * (size_t)f->box[2];
    float *mean = malloc(16 * n);
    assert_non_null(mean);
    assert_ok(gpu_download(t->gpu, f->mean, 0, mean, n));
    return mean;
}

#endif
