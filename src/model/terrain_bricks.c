/* Selects the bricks of a frame's lattice in or near which the surface of the ground may be. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "field/field.h"
#include "model/terrain.h"

/* The margin around a brick, in samples, within which the surface matters: one sample, because the surface may pass between two samples,
 * and the band in which distances are known. */
enum { REACH = 1 + FIELD_BAND };

/* What is within the margin of a brick. */
enum { GROUND = 1, OPEN = 2, SPECIAL = 4 };

/* The bricks whose margin contains from..to (m) along an axis; *last < *first if there are none. */
static void bricks_near(const struct terrain_view *v, const struct surface *s, int axis, double from,
                        double to, int *first, int *last)
{
    const double reach = REACH * v->voxel + s->sigma, side = BRICK_SIDE * v->voxel,
                 low = v->origin[axis] - reach;
    const double high = low + (BRICK_SIDE - 1) * v->voxel + 2 * reach;
    *first = (int)fmin(fmax(ceil((from - high) / side), 0), v->bricks.n[axis]);
    *last = (int)fmax(fmin(floor((to - low) / side), v->bricks.n[axis] - 1), -1);
}

/* The stacks within the margin of bricks `at` along an axis. Beyond the grid the outermost stacks continue. */
static void stacks_near(const struct terrain_view *v, const struct surface *s, int axis, int at, int *first,
                        int *last)
{
    const double reach = REACH * v->voxel + s->sigma, low = v->origin[axis] + at * BRICK_SIDE * v->voxel;
    const double cell = s->stacks->cell, most = s->stacks->n[axis] - 1;
    *first = (int)fmin(fmax(floor((low - reach) / cell), 0), most);
    *last = (int)fmin(fmax(floor((low + (BRICK_SIDE - 1) * v->voxel + reach) / cell), 0), most);
}

/* Whether air around the domain, or the cut, is within the margin of bricks `at` along an axis. */
static bool near_side(const struct terrain_view *v, int axis, int at)
{
    if (field_cut_near(&v->cut, axis, v->origin[axis], v->voxel, BRICK_SIDE * at,
                       BRICK_SIDE * at + BRICK_SIDE - 1))
        return true;
    const int low = at * BRICK_SIDE - REACH, high = at * BRICK_SIDE + BRICK_SIDE - 1 + REACH;
    return low < FIELD_MARGIN || high >= v->n[axis] - FIELD_MARGIN;
}

static void see_stack(const struct terrain_view *v, const struct surface *s, int i, int j, uint8_t *seen)
{
    size_t n;
    const uint32_t *layer = stacks_column(s->stacks, i, j, &n);
    double bottom = -INFINITY;
    for (size_t k = 0; k <= n; k++) {
        const double top = k < n ? layer_top(layer[k]) * s->stacks->quantum : INFINITY;
        const uint32_t m = k < n ? layer_material(layer[k]) : (uint32_t)MATERIAL_AIR;
        const bool ground = s->set >> m & 1;
        int first, last;
        bricks_near(v, s, 2, bottom, top, &first, &last);
        for (int z = first; z <= last; z++)
            seen[z] |= !ground ? OPEN : m == MATERIAL_BEDROCK ? GROUND : GROUND | SPECIAL;
        bottom = top;
    }
}

/* Finds what is within the margins of the column of bricks at (x, y). */
static void see_column(const struct terrain_view *v, const struct surface *s, int x, int y, uint8_t *seen)
{
    int low[2], high[2];
    const bool side = near_side(v, 0, x) || near_side(v, 1, y);
    for (int z = 0; z < v->bricks.n[2]; z++)
        seen[z] = side || near_side(v, 2, z) ? OPEN : 0;
    stacks_near(v, s, 0, x, &low[0], &high[0]);
    stacks_near(v, s, 1, y, &low[1], &high[1]);
    for (int j = low[1]; j <= high[1]; j++)
        for (int i = low[0]; i <= high[0]; i++)
            see_stack(v, s, i, j, seen);
}

/* Sets the slots of bricks (x, y, .): 1 for those to keep. */
static void choose_column(const struct terrain_view *v, int x, int y, const uint8_t *seen)
{
    const int *n = v->bricks.n;
    for (int z = 0; z < n[2]; z++) {
        uint32_t *slot = &v->bricks.slot[((size_t)z * (size_t)n[1] + (size_t)y) * (size_t)n[0] + (size_t)x];
        *slot = !(seen[z] & GROUND) ? 0 : seen[z] == GROUND ? BRICK_INSIDE : 1;
    }
}

status terrain_bricks(struct terrain_view *v, const struct surface *s)
{
    status st = OK;
    struct grid_bricks *b = &v->bricks;
    uint8_t *seen = NULL;
    const size_t all = grid_bricks_of(v->n, b->n), across = (size_t)b->n[0] * (size_t)b->n[1];
    TRY(memory_alloc(all, sizeof *b->slot, "bricks", &b->slot));
    TRY(memory_alloc(all, 1, "bricks", &seen));
#pragma omp parallel for schedule(dynamic, 16)
    for (size_t c = 0; c < across; c++) {
        const int x = (int)(c % (size_t)b->n[0]), y = (int)(c / (size_t)b->n[0]);
        uint8_t *own = seen + c * (size_t)b->n[2];
        see_column(v, s, x, y, own);
        choose_column(v, x, y, own);
    }
    for (size_t i = 0; i < all; i++)
        b->count += b->slot[i] == 1;
    TRY(memory_alloc(b->count, sizeof *b->number, "bricks", &b->number));
    for (size_t i = 0, at = 0; i < all; i++)
        if (b->slot[i] == 1) {
            b->number[at++] = (uint32_t)i;
            b->slot[i] = (uint32_t)at;
        }
done:
    free(seen);
    return st;
}
