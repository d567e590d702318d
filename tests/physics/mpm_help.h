/* Bodies of material points: boxes filled with particles, set moving, and looked at. */
#ifndef HOODOO_TESTS_MPM_HELP_H
#define HOODOO_TESTS_MPM_HELP_H

#include "check.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "mpm/mpm.h"
#include "tests/physics/boxes.h"

struct body {
    struct gpu *gpu;
    struct gpu_work *work;
    struct particles p;
    struct mpm m;
    size_t n;
};

static inline struct mpm_options soft_rock(void)
{
    struct mpm_options o = {.lambda = 12e9,
                            .mu = 15e9,
                            .density = 2300,
                            .gravity = 9.81,
                            .cfl = 0.4,
                            .rebound = 1,
                            .friction = 0.6,
                            .repose_deg = 38,
                            .strength = 1e12,
                            .lift = 0.75};
    mpm_soften(&o, 200);
    return o;
}

/* In a domain of that many cells of size dx, loaded. */
static inline struct body body_of(const struct box *box, size_t n_boxes, const int cells[3], double dx,
                                  const struct mpm_options *options)
{
    struct body b = {0};
    int voxels[3] = {2 * cells[0], 2 * cells[1], 2 * cells[2]};
    size_t n = (size_t)voxels[0] * (size_t)voxels[1] * (size_t)voxels[2], nodes = mpm_nodes(voxels);
    struct rock rock = box_rock(box, n_boxes, voxels, dx / 2);
    assert_ok(gpu_create(&(struct gpu_options){.device = "auto"}, &b.gpu));
    assert_ok(gpu_work_create(b.gpu, (n > nodes ? n : nodes) + 2, &b.work));
    assert_ok(particles_create(b.gpu, b.work, &rock, STATE, voxels, dx / 2, &b.p));
    assert_ok(particles_allow_motion(b.gpu, &b.p));
    b.n = b.p.n;
    assert_ok(mpm_create(b.gpu, voxels, dx / 2, b.n, options, &b.m));
    struct count_params all = {(uint)b.n};
    GPU_RUN(b.gpu, gpu_iota, b.n, all, b.p.flags);
    mpm_load(b.gpu, &b.m, &b.p, b.p.flags, b.n);
    assert_ok(gpu_wait(b.gpu));
    rock_free(&rock);
    return b;
}

static inline void body_end(struct body *b)
{
    mpm_destroy(b->gpu, &b->m);
    particles_destroy(b->gpu, &b->p);
    gpu_work_destroy(b->gpu, &b->work);
    gpu_destroy(&b->gpu);
}

/* The state in host memory: n points in the device's order. */
struct points {
    size_t n;
    float *vector[MPM_VECTORS];
    float *share, *apart;
    uint32_t *id;
};

static inline struct points points_of(struct body *b)
{
    struct points s = {.n = b->m.n};
    for (int v = 0; v < MPM_VECTORS; v++) {
        s.vector[v] = malloc(s.n * 16 + 1);
        assert_ok(gpu_download(b->gpu, b->m.vector[v], 0, s.vector[v], s.n));
    }
    s.share = malloc(s.n * 4 + 1);
    s.apart = malloc(s.n * 4 + 1);
    s.id = malloc(s.n * 4 + 1);
    assert_ok(gpu_download(b->gpu, b->m.word[MPM_SHARE], 0, s.share, s.n));
    assert_ok(gpu_download(b->gpu, b->m.word[MPM_APART], 0, s.apart, s.n));
    assert_ok(gpu_download(b->gpu, b->m.word[MPM_ID], 0, s.id, s.n));
    return s;
}

static inline void points_put(struct body *b, const struct points *s)
{
    for (int v = 0; v < MPM_VECTORS; v++)
        assert_ok(gpu_upload(b->gpu, b->m.vector[v], 0, s->vector[v], s->n));
    assert_ok(gpu_upload(b->gpu, b->m.word[MPM_SHARE], 0, s->share, s->n));
    assert_ok(gpu_upload(b->gpu, b->m.word[MPM_APART], 0, s->apart, s->n));
}

static inline void points_free(struct points *s)
{
    for (int v = 0; v < MPM_VECTORS; v++)
        free(s->vector[v]);
    free(s->share);
    free(s->apart);
    free(s->id);
}

static inline const float *point_x(const struct points *s, size_t i)
{
    return s->vector[MPM_PLACE] + 4 * i;
}

static inline const float *point_v(const struct points *s, size_t i)
{
    return s->vector[MPM_VELOCITY] + 4 * i;
}

/* Column c of the affine velocity (MPM_AFFINE_X) or of H (MPM_STRETCH_X). */
static inline void point_matrix(const struct points *s, enum mpm_vector first, size_t i, double out[3][3])
{
    const float *x = s->vector[first] + 4 * i, *y = s->vector[first + 1] + 4 * i,
                *z = s->vector[first == MPM_AFFINE_X ? MPM_VELOCITY : MPM_PLACE] + 4 * i;
    for (int r = 0; r < 3; r++) {
        out[r][0] = (double)x[r];
        out[r][1] = (double)y[r];
    }
    out[0][2] = (double)x[3];
    out[1][2] = (double)y[3];
    out[2][2] = (double)z[3];
}

static inline void point_set_matrix(struct points *s, enum mpm_vector first, size_t i, const double m[3][3])
{
    float *x = s->vector[first] + 4 * i, *y = s->vector[first + 1] + 4 * i,
          *z = s->vector[first == MPM_AFFINE_X ? MPM_VELOCITY : MPM_PLACE] + 4 * i;
    for (int r = 0; r < 3; r++) {
        x[r] = (float)m[r][0];
        y[r] = (float)m[r][1];
    }
    x[3] = (float)m[0][2];
    y[3] = (float)m[1][2];
    z[3] = (float)m[2][2];
}

/* Mass, momentum, angular momentum about the origin (the affine part included), kinetic energy; for points of
 * equal mass `whole` times share. */
struct totals {
    double mass, p[3], l[3], kinetic, middle[3];
};

static inline struct totals totals_of(const struct body *b, const struct points *s)
{
    struct totals t = {0};
    double whole = b->m.options.density * pow(b->m.dx / 2, 3), d = b->m.dx * b->m.dx / 4;
    for (size_t i = 0; i < s->n; i++) {
        double m = whole * (double)s->share[i], C[3][3], x[3], v[3];
        point_matrix(s, MPM_AFFINE_X, i, C);
        for (int a = 0; a < 3; a++) {
            x[a] = (double)point_x(s, i)[a];
            v[a] = (double)point_v(s, i)[a];
        }
        t.mass += m;
        for (int a = 0; a < 3; a++) {
            int e = (a + 1) % 3, f = (a + 2) % 3;
            t.p[a] += m * v[a];
            t.middle[a] += m * x[a];
            t.l[a] += m * (x[e] * v[f] - x[f] * v[e] + d * (C[f][e] - C[e][f]));
            t.kinetic += 0.5 * m * v[a] * v[a];
            for (int c = 0; c < 3; c++)
                t.kinetic += 0.5 * m * d * C[a][c] * C[a][c];
        }
    }
    for (int a = 0; a < 3; a++)
        t.middle[a] /= t.mass;
    return t;
}

#endif
