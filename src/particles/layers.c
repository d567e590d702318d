#include "particles/layers.h"

#include <math.h>
#include <stdlib.h>

#include "base/memory.h"

enum { MAX_CELLS = 2048 }; /* on an axis */

static int cell_on(const struct layers *l, int axis, float x)
{
    double c = floor(((double)x - l->low[axis]) / l->cell);
    return (int)fmin(fmax(c, -1e6), 1e6);
}

static size_t cell_of(const struct layers *l, const float at[3])
{
    size_t c = 0;
    for (int a = 2; a >= 0; a--)
        c = c * (size_t)l->n[a] + (size_t)cell_on(l, a, at[a]);
    return c;
}

status layers_create(const struct rock *rock, double spacing, struct layers *out)
{
    status st = OK;
    size_t cells = 1;
    *out = (struct layers){.rock = rock, .cell = spacing};
    for (int a = 0; a < 3; a++) {
        double high = -INFINITY;
        out->low[a] = INFINITY;
        for (size_t p = 0; p < rock->n; p++) {
            out->low[a] = fmin(out->low[a], (double)rock->P[4 * p + (size_t)a]);
            high = fmax(high, (double)rock->P[4 * p + (size_t)a]);
        }
        double n = rock->n ? floor((high - out->low[a]) / spacing) + 1 : 1;
        if (!(n <= MAX_CELLS))
            return fail(E_INPUT, "its particles span %g spacings; at most %d", n, MAX_CELLS);
        out->n[a] = (int)n;
        cells *= (size_t)n;
    }
    TRY(memory_alloc(cells + 1, sizeof *out->first, "particles by place", &out->first));
    TRY(memory_alloc(rock->n, sizeof *out->sorted, "particles by place", &out->sorted));
    for (size_t p = 0; p < rock->n; p++)
        out->first[cell_of(out, rock->P + 4 * p)]++;
    for (size_t c = 0, sum = 0; c <= cells; c++) {
        sum += out->first[c];
        out->first[c] = sum;
    }
    for (size_t p = rock->n; p-- > 0;)
        out->sorted[--out->first[cell_of(out, rock->P + 4 * p)]] = (uint32_t)p;
done:
    if (st != OK)
        layers_destroy(out);
    return st;
}

void layers_destroy(struct layers *l)
{
    free(l->first);
    free(l->sorted);
    *l = (struct layers){0};
}

/* The nearest particle in the cells within `reach` cells of at's. */
static double nearest(const struct layers *l, const float at[3], int reach, uint32_t *which)
{
    double least = INFINITY;
    int low[3], high[3];
    for (int a = 0; a < 3; a++) {
        int c = cell_on(l, a, at[a]);
        low[a] = c - reach > 0 ? c - reach : 0;
        high[a] = c + reach < l->n[a] ? c + reach : l->n[a] - 1;
    }
    for (int z = low[2]; z <= high[2]; z++)
        for (int y = low[1]; y <= high[1]; y++)
            for (int x = low[0]; x <= high[0]; x++) {
                size_t c = ((size_t)z * (size_t)l->n[1] + (size_t)y) * (size_t)l->n[0] + (size_t)x;
                for (size_t i = l->first[c]; i < l->first[c + 1]; i++) {
                    const float *P = l->rock->P + 4 * (size_t)l->sorted[i];
                    double d2 = 0;
                    for (int a = 0; a < 3; a++)
                        d2 += ((double)P[a] - (double)at[a]) * ((double)P[a] - (double)at[a]);
                    if (d2 < least || (d2 == least && l->sorted[i] < *which)) {
                        least = d2;
                        *which = l->sorted[i];
                    }
                }
            }
    return sqrt(least);
}

bool layers_at(const struct layers *l, const float at[3], uint32_t *layer)
{
    uint32_t which = 0;
    for (int reach = 1; reach <= 2; reach++)
        if (l->rock->n && nearest(l, at, reach, &which) <= reach * l->cell) {
            *layer = l->rock->layer[which];
            return true;
        }
    return false;
}
