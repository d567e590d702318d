/* A small frame with known content: a ball of rock in a box, and particles on a lattice inside it. */
#ifndef HOODOO_SAMPLE_FRAME_H
#define HOODOO_SAMPLE_FRAME_H

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "vdb/vdb.h"

/* Not centred and with three different sides, so that swapped axes show. */
static const double BALL_CENTRE[3] = {7.25, 5.5, 6.0};
static const double BALL_RADIUS = 4.0;

static inline double ball_distance(const double x[3])
{
    double d[3] = {x[0] - BALL_CENTRE[0], x[1] - BALL_CENTRE[1], x[2] - BALL_CENTRE[2]};
    return sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]) - BALL_RADIUS;
}

/* The value of `stress` at a point: linear, so that trilinear sampling is exact. */
static inline double ball_stress(const double x[3])
{
    return 1e5 + 2e3 * x[0] - 3e3 * x[1] + 5e3 * x[2];
}

/* A sample of what sample_grids() has. */
struct ball_sample {
    float surface, density, stress, vel[3];
};

static inline struct ball_sample ball_sample(const struct grid_lattice *l, const int c[3])
{
    double x[3];
    for (int a = 0; a < 3; a++)
        x[a] = l->origin[a] + c[a] * l->voxel;
    const double d = ball_distance(x), fill = 0.5 - d / l->voxel;
    struct ball_sample s = {.surface = (float)d,
                            .density = (float)(fill < 0   ? 0
                                               : fill > 1 ? 1
                                                          : fill),
                            .stress = (float)ball_stress(x)};
    if (d > 0 && d < 1) {
        s.vel[0] = 1;
        s.vel[1] = 2;
        s.vel[2] = (float)x[2];
    }
    return s;
}

/* Calls for each sample of a brick, with where it is in an array. */
static inline void sample_brick(struct frame_grids *g, uint32_t number, size_t at, bool *held)
{
    const int *m = g->bricks.n;
    for (int v = 0; v < BRICK_SAMPLES; v++) {
        const int c[3] = {(int)number % m[0] * BRICK_SIDE + v % BRICK_SIDE,
                          (int)number / m[0] % m[1] * BRICK_SIDE + v / BRICK_SIDE % BRICK_SIDE,
                          (int)number / m[0] / m[1] * BRICK_SIDE + v / BRICK_SIDE / BRICK_SIDE};
        bool inside = true;
        for (int a = 0; a < 3; a++)
            inside = inside && c[a] < g->lattice.n[a];
        struct ball_sample s = {.surface = grid_background(g, &g->grid[0])};
        if (inside)
            s = ball_sample(&g->lattice, c);
        *held = *held || (double)s.surface < fmax(1, GRID_BAND * g->lattice.voxel);
        if (!g->grid[0].value)
            continue;
        g->grid[0].value[at + (size_t)v] = s.surface;
        g->grid[1].value[at + (size_t)v] = s.density;
        g->grid[2].value[at + (size_t)v] = s.stress;
        memcpy(g->grid[3].value + 3 * (at + (size_t)v), s.vel, sizeof s.vel);
    }
}

/* surface, density, stress and vel on a lattice of `voxel` metres: in the bricks that hold rock, or air within a metre of it. */
static inline status sample_grids(double voxel, struct frame_grids *g)
{
    status st = OK;
    const double size[3] = {13, 12, 11.5};
    const enum value_id value[4] = {VALUE_surface, VALUE_density, VALUE_stress, VALUE_vel};
    struct grid_lattice l = {.voxel = voxel, .origin = {1 + voxel / 2, -0.5 + voxel / 2, 0.25 + voxel / 2}};
    uint32_t *number = NULL;
    size_t n = 0;
    for (int a = 0; a < 3; a++)
        l.n[a] = (int)(size[a] / voxel);
    TRY(frame_grids_begin(&l, g));
    for (int i = 0; i < 4; i++) {
        struct frame_grid *grid;
        TRY(frame_grids_add(g, value[i], &grid));
    }
    const int *m = g->bricks.n;
    const size_t all = (size_t)m[0] * (size_t)m[1] * (size_t)m[2];
    TRY(memory_alloc(all, sizeof *number, "bricks", &number));
    for (uint32_t b = 0; b < all; b++) {
        bool held = false;
        sample_brick(g, b, 0, &held);
        if (held)
            number[n++] = b;
    }
    frame_grids_choose(g, &number, n);
    for (size_t i = 0; i < 4; i++)
        TRY(memory_alloc(n * BRICK_SAMPLES * (i == 3 ? 3 : 1), sizeof(float), "samples", &g->grid[i].value));
    for (size_t b = 0; b < n; b++)
        sample_brick(g, g->bricks.number[b], b * BRICK_SAMPLES, &(bool){false});
done:
    free(number);
    return st;
}

/* Particles spaced `h` filling the ball, in a shuffled order. */
static inline status sample_rock(double h, struct rock *rock)
{
    status st = OK;
    size_t n = 0;
    const int m = (int)(2 * BALL_RADIUS / h) + 1;
    TRY(rock_alloc(rock, (size_t)m * (size_t)m * (size_t)m, DERIVED));
    for (int c = 0; c < m * m * m; c++) {
        const int s = (int)((long long)c * 7919 % (m * m * m)), i[3] = {s % m, s / m % m, s / m / m};
        double x[3];
        for (int a = 0; a < 3; a++)
            x[a] = BALL_CENTRE[a] - BALL_RADIUS + (i[a] + 0.5) * h;
        const double d = ball_distance(x);
        if (d > 0)
            continue;
        for (int a = 0; a < 3; a++) {
            rock->P[4 * n + (size_t)a] = (float)x[a];
            if (d > -h)
                rock->N[4 * n + (size_t)a] = (float)((x[a] - BALL_CENTRE[a]) / (d + BALL_RADIUS));
        }
        rock->id[n] = (uint32_t)s;
        rock->viability[n] = (float)(s % 97) / 97;
        rock->layer[n] = x[2] > BALL_CENTRE[2];
        rock->phase[n] = s % 5 == 0;
        rock->stress[n] = (float)ball_stress(x);
        rock->erodibility[n] = 0.25F;
        n++;
    }
    rock->n = n;
done:
    return st;
}

#endif
