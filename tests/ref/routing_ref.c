#include "routing_ref.h"

#include <math.h>
#include <stdlib.h>

#include "base/random.h"
#include "shared/params.h"

static uint32_t kind(const struct routing_ref *r, size_t c)
{
    return r->tag[c] & WATER_KIND;
}

static uint32_t choose(const struct routing_ref *r, const int at[3], size_t c, uint32_t seed)
{
    size_t row = (size_t)r->cells[0], slab = row * (size_t)r->cells[1];
    const size_t beside[4] = {c + 1, c - 1, c + row, c - row};
    uint32_t hash = random_hash(seed, (uint32_t)c, 1, 0), open[4], n_open = 0;
    double sum = 0, at_sum;
    if (r->tag[c] & WATER_OUT)
        return (uint32_t)c;
    if (kind(r, c) == WATER_EMPTY)
        return (uint32_t)(c - slab);
    if (kind(r, c) == WATER_SOLID && at[2] > 0 && kind(r, c - slab) == WATER_EMPTY)
        return (uint32_t)(c - slab);
    for (int s = 0; s < 4; s++)
        if (kind(r, beside[s]) == WATER_EMPTY)
            open[n_open++] = (uint32_t)beside[s];
    if (n_open)
        return open[hash % n_open];
    if (kind(r, c) != WATER_SURF)
        return (uint32_t)c;
    for (int s = 0; s < 4; s++)
        if (kind(r, beside[s]) == WATER_SURF && r->z[beside[s]] < r->z[c])
            sum += r->z[c] - r->z[beside[s]];
    at_sum = sum * (double)random_float(hash);
    for (int s = 0; s < 4; s++)
        if (kind(r, beside[s]) == WATER_SURF && r->z[beside[s]] < r->z[c]) {
            at_sum -= r->z[c] - r->z[beside[s]];
            if (at_sum < 0)
                return (uint32_t)beside[s];
        }
    return (uint32_t)c;
}

struct routing_ref routing_ref(const struct rock *rock, const int voxels[3], double h, uint32_t seed,
                               int unshifted)
{
    struct routing_ref r = {0};
    size_t n = 1;
    for (int a = 0; a < 3; a++) {
        r.shift[a] = unshifted ? 0 : (int)(random_hash(seed, (uint32_t)a, 0, 0) & 1);
        r.cells[a] = voxels[a] / 2 + r.shift[a];
        n *= (size_t)r.cells[a];
    }
    size_t slab = (size_t)r.cells[0] * (size_t)r.cells[1];
    r.tag = calloc(n, 4);
    r.z = calloc(n, 4);
    r.receiver = calloc(n, 4);
    for (size_t i = 0; i < rock->n; i++) {
        size_t c = 0;
        double x[3];
        for (int a = 2; a >= 0; a--) {
            x[a] = (double)rock->P[4 * i + (size_t)a] / h;
            c = c * (size_t)r.cells[a] + (size_t)(((int)floor(x[a]) + r.shift[a]) / 2);
        }
        uint32_t z = (uint32_t)((x[2] + r.shift[2]) * 32768);
        r.tag[c] = WATER_SOLID;
        r.z[c] = z > r.z[c] ? z : r.z[c];
    }
    for (size_t c = 0; c < n; c++) {
        int at[3] = {(int)(c % (size_t)r.cells[0]), (int)(c / (size_t)r.cells[0]) % r.cells[1],
                     (int)(c / slab)};
        if (r.tag[c] == WATER_SOLID && (c + slab >= n || r.tag[c + slab] == WATER_EMPTY))
            r.tag[c] = WATER_SURF;
        if (r.tag[c] == WATER_EMPTY)
            r.z[c] = (uint32_t)at[2] << 16;
        if (at[0] == 0 || at[1] == 0 || at[0] == r.cells[0] - 1 || at[1] == r.cells[1] - 1 ||
            (at[2] == 0 && r.tag[c] == WATER_EMPTY))
            r.tag[c] |= WATER_OUT;
    }
    for (size_t c = 0; c < n; c++) {
        int at[3] = {(int)(c % (size_t)r.cells[0]), (int)(c / (size_t)r.cells[0]) % r.cells[1],
                     (int)(c / slab)};
        r.receiver[c] = choose(&r, at, c, seed);
        if (r.tag[c] == WATER_SOLID && r.receiver[c] != c)
            r.tag[c] = WATER_WALL;
    }
    /* Falls end where they end. */
    for (size_t c = 0; c < n; c++) {
        uint32_t to = r.receiver[c];
        while ((r.tag[to] & (WATER_KIND | WATER_OUT)) == WATER_EMPTY)
            to = r.receiver[to];
        r.receiver[c] = to;
    }
    return r;
}

void routing_ref_free(struct routing_ref *r)
{
    free(r->tag);
    free(r->z);
    free(r->receiver);
    *r = (struct routing_ref){0};
}
