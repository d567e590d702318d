/* A small frame with known content: a ball of rock in a box, and particles on a lattice inside it. */
#ifndef HOODOO_SAMPLE_FRAME_H
#define HOODOO_SAMPLE_FRAME_H

#include <math.h>
#include <string.h>

#include "base/memory.h"
#include "output/vdb.h"

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

/* surface, density, stress and vel on a grid of `voxel` metres. */
static inline status sample_grids(double voxel, struct frame_grids *g)
{
    status st = OK;
    size_t total = 1;
    *g = (struct frame_grids){
        .voxel = voxel, .origin = {1 + voxel / 2, -0.5 + voxel / 2, 0.25 + voxel / 2}, .n_grids = 4};
    const double size[3] = {13, 12, 11.5};
    for (int a = 0; a < 3; a++) {
        g->n[a] = (int)(size[a] / voxel);
        total *= (size_t)g->n[a];
    }
    g->grid[0] = (struct frame_grid){.name = "surface", .unit = "m", .kind = GRID_LEVEL_SET};
    g->grid[1] = (struct frame_grid){.name = "density", .unit = "", .kind = GRID_FOG};
    g->grid[2] = (struct frame_grid){.name = "stress", .unit = "Pa", .kind = GRID_PLAIN};
    g->grid[3] = (struct frame_grid){.name = "vel", .unit = "m/s", .kind = GRID_PLAIN, .components = 3};
    for (size_t i = 0; i < 4; i++)
        TRY(memory_alloc(total * (i == 3 ? 3 : 1), sizeof(float), "a sample grid", &g->grid[i].value));
    for (size_t v = 0; v < total; v++) {
        const size_t nx = (size_t)g->n[0], ny = (size_t)g->n[1], c[3] = {v % nx, v / nx % ny, v / nx / ny};
        double x[3];
        for (int a = 0; a < 3; a++)
            x[a] = g->origin[a] + (double)c[a] * voxel;
        const double d = ball_distance(x), fill = 0.5 - d / voxel;
        g->grid[0].value[v] = (float)d;
        g->grid[1].value[v] = (float)(fill < 0 ? 0 : fill > 1 ? 1 : fill);
        g->grid[2].value[v] = (float)ball_stress(x);
        if (d > 0) {
            g->grid[3].value[3 * v] = 1;
            g->grid[3].value[3 * v + 1] = 2;
            g->grid[3].value[3 * v + 2] = (float)x[2];
        }
    }
done:
    return st;
}

static inline void sample_grids_free(struct frame_grids *g)
{
    for (size_t i = 0; i < g->n_grids; i++)
        free(g->grid[i].value);
    *g = (struct frame_grids){0};
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
