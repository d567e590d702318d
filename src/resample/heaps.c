/* Deposits at a smaller spacing.
 *
 * A column of deposits that lie on each other becomes k x k columns. Their tops follow the slope of the heap, so that it does not become a
 * staircase of the old voxels, which would slide; together they have as many particles as there were times k^3. Deposits under a roof
 * keep their voxels. */
#include <math.h>
#include <stdlib.h>

#include "base/memory.h"
#include "base/random.h"
#include "resample/change.h"

enum { NEAR = 2 }; /* voxels: ground higher or lower than that beside a column does not belong to its heap */

/* The deposits from z[0] to z[1] - 1 in the old column x, y. */
struct column {
    int x, y, z[2];
};

struct heaps {
    struct change *c;
    size_t *particle; /* by index in c->deposits: the first in the voxel; SIZE_MAX: it has been appended */
};

static bool is_ground(const struct change *c, int x, int y, int z)
{
    return change_ground(c, (const int[]){x, y, z}) >= 0.5;
}

/* Finds the height of the ground beside a column's top, in voxels. False: there is a wall, a drop or the end of the domain. */
static bool height_beside(const struct change *c, const struct column *at, int dx, int dy, double *height)
{
    const int x = at->x + dx, y = at->y + dy, top = at->z[1];
    const struct spacing *s = &c->r->was;
    if (x < 0 || y < 0 || x >= s->n[0] || y >= s->n[1])
        return false;
    for (int z = top + NEAR; z >= top - NEAR; z--)
        if (is_ground(c, x, y, z - 1)) {
            *height = z - 1 + change_ground(c, (const int[]){x, y, z - 1});
            return z < top + NEAR;
        }
    return false;
}

/* The slope of the heap along an axis. */
static double slope(const struct change *c, const struct column *at, int dx, int dy)
{
    double above = 0, below = 0, sum = 0;
    const bool has_above = height_beside(c, at, dx, dy, &above),
               has_below = height_beside(c, at, -dx, -dy, &below);
    if (has_above)
        sum += above - at->z[1];
    if (has_below)
        sum += at->z[1] - below;
    sum /= has_above && has_below ? 2 : 1;
    return fmin(fmax(sum, -1), 1);
}

/* The number of particles in each of the k x k new columns. */
static void heights(const struct change *c, const struct column *at, int *n)
{
    const int k = c->r->k, all = k * k, length = at->z[1] - at->z[0];
    const bool roof = at->z[1] < c->r->was.n[2] && is_ground(c, at->x, at->y, at->z[1]);
    const double gx = roof ? 0 : slope(c, at, 1, 0), gy = roof ? 0 : slope(c, at, 0, 1);
    double want[RESAMPLE_MOST * RESAMPLE_MOST];
    int more = all * k * length;
    for (int i = 0; i < all; i++) {
        const double ox = (i % k + 0.5) / k - 0.5, oy = (i / k + 0.5) / k - 0.5;
        const uint32_t hash = random_hash((uint32_t)(at->x * k + i % k), (uint32_t)(at->y * k + i / k), 0, 0);
        /* A hash decides between columns that want the same. */
        want[i] = k * (length + gx * ox + gy * oy) + (roof ? 0 : 1e-3 * (double)random_float(hash));
        n[i] = (int)fmax(floor(want[i]), 0);
        more -= n[i];
    }
    for (; more != 0; more += more < 0 ? 1 : -1) {
        int best = -1;
        for (int i = 0; i < all; i++)
            if (more > 0 ? best < 0 || want[i] - n[i] > want[best] - n[best]
                         : n[i] > 0 && (best < 0 || want[i] - n[i] < want[best] - n[best]))
                best = i;
        n[best] += more < 0 ? -1 : 1;
    }
}

static void append_column(struct heaps *h, const struct column *at)
{
    struct change *c = h->c;
    const int k = c->r->k;
    int n[RESAMPLE_MOST * RESAMPLE_MOST];
    heights(c, at, n);
    for (int i = 0; i < k * k; i++)
        for (int z = 0; z < n[i]; z++) {
            const int child[3] = {at->x * k + i % k, at->y * k + i / k, at->z[0] * k + z};
            const int old = at->z[0] + z / k < at->z[1] ? at->z[0] + z / k : at->z[1] - 1;
            const size_t p = h->particle[voxel_set_index(&c->deposits, (const int[]){at->x, at->y, old})];
            if (spacing_holds(&c->r->is, child))
                change_append(c, child, NULL, SIZE_MAX, 1, 1, p, c->was->viability[p]);
        }
}

/* Appends the columns whose lowest voxel is in this layer. */
static void append_layer(struct heaps *h, int z)
{
    const struct voxel_set *set = &h->c->deposits;
    const size_t layer = set->words / (size_t)set->n[2];
    for (size_t w = (size_t)z * layer; w < (size_t)(z + 1) * layer; w++)
        EACH_BIT(set->bits[w], {
            int v[3];
            voxel_set_at(set, w, bit, v);
            struct column at = {v[0], v[1], {z, z + 1}};
            if (z > 0 && voxel_set_has(set, (const int[]){v[0], v[1], z - 1}))
                continue;
            while (at.z[1] < set->n[2] && voxel_set_has(set, (const int[]){v[0], v[1], at.z[1]}))
                at.z[1]++;
            append_column(h, &at);
        })
}

size_t heaps_most(const struct change *c)
{
    const size_t k = (size_t)c->r->k;
    size_t n = 0;
    for (size_t p = 0; p < c->was->n; p++)
        n += c->was->phase[p] == 1;
    return n * k * k * k;
}

status heaps_divide(struct change *c)
{
    status st = OK;
    struct heaps h = {.c = c};
    const size_t n = voxel_set_count(&c->deposits);
    int v[3];
    TRY(memory_alloc(n, sizeof *h.particle, "deposits", &h.particle));
    for (size_t i = 0; i < n; i++)
        h.particle[i] = SIZE_MAX;
    for (size_t p = 0; p < c->was->n; p++) {
        if (c->was->phase[p] != 1)
            continue;
        voxel_of(&c->r->was, c->was->P + 4 * p, v);
        size_t *first = &h.particle[voxel_set_index(&c->deposits, v)];
        if (*first == SIZE_MAX)
            *first = p;
        else /* a second one in its voxel */
            EACH_CHILD(c->r, v, change_append(c, child, NULL, SIZE_MAX, 1, 1, p, c->was->viability[p]);)
    }
    for (int z = 0; z < c->deposits.n[2]; z++)
        append_layer(&h, z);
done:
    free(h.particle);
    return st;
}
