/* Particles are sorted into cells as wide as the reach, so all candidates for a point are in its cell and the
 * 26 cells around it. */
#include "render/closest.h"

#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"

struct cells {
    double low[3], width;
    int64_t n[3];
    uint32_t *start; /* [cells + 1]: where each cell's particles begin in `order` */
    uint32_t *order;
};

enum { CELLS_MAX = 1 << 26 };

static int64_t along(const struct cells *c, int axis, double x)
{
    double at = floor((x - c->low[axis]) / c->width);
    return at < 0 ? -1 : at < (double)c->n[axis] ? (int64_t)at : c->n[axis];
}

static size_t cell_of(const struct cells *c, const float *p)
{
    return (size_t)((along(c, 2, (double)p[2]) * c->n[1] + along(c, 1, (double)p[1])) * c->n[0] +
                    along(c, 0, (double)p[0]));
}

static status sort(struct cells *c, const float *particle, size_t n, double reach)
{
    status st = OK;
    double high[3] = {-INFINITY, -INFINITY, -INFINITY};
    for (int k = 0; k < 3; k++)
        c->low[k] = INFINITY;
    for (size_t i = 0; i < n; i++)
        for (int k = 0; k < 3; k++) {
            double x = (double)particle[4 * i + (size_t)k];
            if (!isfinite(x))
                return fail(E_INPUT, "the position of particle %zu is not finite", i);
            c->low[k] = fmin(c->low[k], x);
            high[k] = fmax(high[k], x);
        }
    double cells = 1;
    c->width = reach;
    for (int k = 0; k < 3; k++)
        cells *= floor((high[k] - c->low[k]) / reach) + 1;
    if (cells > CELLS_MAX || n >= UINT32_MAX)
        return fail(
            E_INPUT,
            "%zu particles span %g cells of %g m, which is too many: are some of them far away from the rest?",
            n, cells, reach);
    for (int k = 0; k < 3; k++)
        c->n[k] = (int64_t)floor((high[k] - c->low[k]) / reach) + 1;
    size_t n_cells = (size_t)cells;
    TRY(memory_alloc(n_cells + 2, sizeof *c->start, "cells", &c->start));
    TRY(memory_alloc(n, sizeof *c->order, "cells", &c->order));
    /* Counts are stored one place further on, so that filling the cells moves each start to its place. */
    for (size_t i = 0; i < n; i++)
        c->start[cell_of(c, particle + 4 * i) + 2]++;
    for (size_t i = 2; i < n_cells + 2; i++)
        c->start[i] += c->start[i - 1];
    for (size_t i = 0; i < n; i++)
        c->order[c->start[cell_of(c, particle + 4 * i) + 1]++] = (uint32_t)i;
done:
    return st;
}

static float value_near(const struct cells *c, const float *x, const float *particle, const float *value)
{
    double best = c->width * c->width;
    uint32_t which = UINT32_MAX;
    int64_t at[3];
    for (int k = 0; k < 3; k++)
        at[k] = along(c, k, (double)x[k]);
    for (int64_t cz = at[2] - 1; cz <= at[2] + 1; cz++)
        for (int64_t cy = at[1] - 1; cy <= at[1] + 1; cy++)
            for (int64_t cx = at[0] - 1; cx <= at[0] + 1; cx++) {
                if (cx < 0 || cy < 0 || cz < 0 || cx >= c->n[0] || cy >= c->n[1] || cz >= c->n[2])
                    continue;
                size_t cell = (size_t)((cz * c->n[1] + cy) * c->n[0] + cx);
                for (uint32_t i = c->start[cell]; i < c->start[cell + 1]; i++) {
                    const float *p = particle + 4 * (size_t)c->order[i];
                    double d = 0;
                    for (int k = 0; k < 3; k++)
                        d += ((double)p[k] - (double)x[k]) * ((double)p[k] - (double)x[k]);
                    if (d < best || (d == best && c->order[i] < which)) {
                        best = d;
                        which = c->order[i];
                    }
                }
            }
    return which == UINT32_MAX ? 0 : value[which];
}

status closest_values(const float *point, size_t n_points, const float *particle, const float *value,
                      size_t n_particles, double reach, float *out)
{
    status st = OK;
    struct cells c = {0};
    memset(out, 0, n_points * sizeof *out);
    if (n_particles == 0)
        goto done;
    TRY(sort(&c, particle, n_particles, reach));
    for (size_t i = 0; i < n_points; i++)
        out[i] = value_near(&c, point + 3 * i, particle, value);
done:
    free(c.start);
    free(c.order);
    return st;
}
