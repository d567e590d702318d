/* What a frame's surface is like: its volume, its centre, how far it is along a ray, how round. */
#ifndef HOODOO_TESTS_SURFACE_H
#define HOODOO_TESTS_SURFACE_H

#include <math.h>
#include <string.h>

#include "particles/frame.h"

struct surface {
    const struct frame_grids *grids;
    const struct frame_grid *phi; /* m, negative inside */
    double volume, center[3];
};

static inline double surface_at(const struct surface *s, const double x[3])
{
    const struct grid_lattice *l = &s->grids->lattice;
    int c[3];
    double f[3], sum = 0;
    for (int a = 0; a < 3; a++) {
        double p = fmin(fmax((x[a] - l->origin[a]) / l->voxel, 0), l->n[a] - 1.001);
        c[a] = (int)p;
        f[a] = p - c[a];
    }
    for (int k = 0; k < 8; k++) {
        double weight = (k & 1 ? f[0] : 1 - f[0]) * (k & 2 ? f[1] : 1 - f[1]) * (k & 4 ? f[2] : 1 - f[2]);
        sum +=
            weight * (double)grid_at(s->grids, s->phi, c[0] + (k & 1), c[1] + (k >> 1 & 1), c[2] + (k >> 2));
    }
    return sum;
}

/* Volume and centre by a step smoothed over 1.5 voxels to either side. */
static inline struct surface surface_of(const struct frame *frame)
{
    const struct grid_lattice *l = &frame->grids.lattice;
    struct surface s = {.grids = &frame->grids, .phi = frame_grid_named(&frame->grids, "surface")};
    double width = 1.5 * l->voxel, cell = pow(l->voxel, 3);
    for (int k = 1; k + 1 < l->n[2]; k++)
        for (int j = 1; j + 1 < l->n[1]; j++)
            for (int i = 1; i + 1 < l->n[0]; i++) {
                const int at[3] = {i, j, k};
                double d = -(double)grid_at(s.grids, s.phi, i, j, k) / width;
                double inside = d > 1 ? 1 : d < -1 ? 0 : 0.5 * (1 + d + sin(M_PI * d) / M_PI);
                for (int a = 0; a < 3; a++)
                    s.center[a] += inside * cell * (l->origin[a] + at[a] * l->voxel);
                s.volume += inside * cell;
            }
    for (int a = 0; a < 3; a++)
        s.center[a] /= s.volume;
    return s;
}

/* How far the surface is from `from` along the unit vector, m; 0 if it begins outside. */
static inline double surface_reach(const struct surface *s, const double from[3], const double along[3])
{
    double step = 0.1 * s->grids->lattice.voxel, before = surface_at(s, from);
    if (before > 0)
        return 0;
    for (double t = step;; t += step) {
        double x[3];
        for (int a = 0; a < 3; a++)
            x[a] = from[a] + t * along[a];
        double now = surface_at(s, x);
        if (now > 0)
            return t - step * now / (now - before);
        before = now;
    }
}

/* The surface as seen from its centre, all of which must be in sight: its radii in m, and its sphericity (36
 * pi V^2 / A^3)^(1/3), 1 for a ball and 0.806 for a cube, with V and A as means over 2000 directions. */
struct roundness {
    double least, most, mean, sphericity;
};

static inline struct roundness surface_roundness(const struct surface *s)
{
    enum { N = 2000 };
    struct roundness r = {.least = 1e30};
    double volume = 0, area = 0;
    for (int i = 0; i < N; i++) {
        double z = 1 - (2 * i + 1.0) / N, level = sqrt(1 - z * z), turn = 2.399963229728653 * i;
        const double d[3] = {level * cos(turn), level * sin(turn), z};
        double reach = surface_reach(s, s->center, d), along = 0, length = 0;
        for (int a = 0; a < 3; a++) {
            double x[2][3];
            for (int side = 0; side < 2; side++)
                for (int b = 0; b < 3; b++)
                    x[side][b] =
                        s->center[b] + reach * d[b] + (a == b) * (side - 0.5) * s->grids->lattice.voxel;
            double slope = surface_at(s, x[1]) - surface_at(s, x[0]);
            along += slope * d[a];
            length += slope * slope;
        }
        volume += 4 * M_PI / 3 * reach * reach * reach / N;
        area += 4 * M_PI * reach * reach * sqrt(length) / along / N;
        r.least = fmin(r.least, reach);
        r.most = fmax(r.most, reach);
        r.mean += reach / N;
    }
    r.sphericity = cbrt(36 * M_PI * volume * volume / pow(area, 3));
    return r;
}

#endif
