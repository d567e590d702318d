#include <math.h>
#include <stdlib.h>

#include "base/memory.h"
#include "stacks/spaces.h"
#include "stacks/tools.h"

struct flood {
    struct spaces spaces;
    uint32_t level;
    int slot; /* water's */
    struct wet {
        int i, j, k;
    } * queue;
    size_t n, capacity;
};

static uint32_t ground_of(const struct flood *f, const struct space *s)
{
    uint32_t z = s->floor;
    for (int k = 0; k < f->spaces.kinds.n; k++)
        z += k == f->slot ? 0 : s->amount[k];
    return z;
}

/* Queues a space if its ground is below the water level. */
static status push(struct flood *f, struct space_tile *tile, int i, int j, int k)
{
    uint32_t at = tile->first[j % STACK_TILE * STACK_TILE + i % STACK_TILE] + (uint32_t)k;
    if (tile->mark[at] || ground_of(f, &tile->space[at]) >= f->level)
        return OK;
    status st = memory_grow(&f->queue, &f->capacity, f->n + 1, sizeof *f->queue, "water");
    if (st != OK)
        return st;
    tile->mark[at] = 1;
    tile->changed = true;
    f->queue[f->n++] = (struct wet){i, j, k};
    return OK;
}

/* Queues the neighbouring spaces that water flows into: their openings overlap below the level and above both grounds. */
static status push_neighbours(struct flood *f, const struct wet *w)
{
    static const int neighbour[4][2] = {{1, 0}, {-1, 0}, {0, 1}, {0, -1}};
    status st = OK;
    const struct stacks *g = f->spaces.stacks;
    int n;
    const struct space own = spaces_at(&f->spaces, w->i, w->j, &n)[w->k];
    for (int b = 0; b < 4; b++) {
        int i = w->i + neighbour[b][0], j = w->j + neighbour[b][1];
        struct space_tile *tile;
        if (i < 0 || j < 0 || i >= g->n[0] || j >= g->n[1])
            continue;
        TRY(spaces_tile(&f->spaces, i, j, &tile));
        const struct space *other = spaces_at(&f->spaces, i, j, &n);
        for (int k = 0; k < n; k++) {
            uint32_t lo = ground_of(f, &own), lo2 = ground_of(f, &other[k]);
            uint32_t hi = own.ceiling < other[k].ceiling ? own.ceiling : other[k].ceiling;
            lo = lo2 > lo ? lo2 : lo;
            hi = hi < f->level ? hi : f->level;
            if (hi > lo)
                TRY(push(f, tile, i, j, k));
        }
    }
done:
    return st;
}

/* Queues the space that contains the point, or the first one above it. */
static status seed(struct flood *f, const double at[3])
{
    status st = OK;
    const struct stacks *g = f->spaces.stacks;
    int i = (int)fmin(fmax(floor(at[0] / g->cell), -1), g->n[0]);
    int j = (int)fmin(fmax(floor(at[1] / g->cell), -1), g->n[1]), n;
    uint32_t z = stacks_quanta(g, at[2]);
    struct space_tile *tile;
    if (i < 0 || j < 0 || i >= g->n[0] || j >= g->n[1])
        return OK;
    TRY(spaces_tile(&f->spaces, i, j, &tile));
    const struct space *space = spaces_at(&f->spaces, i, j, &n);
    for (int k = 0; k < n; k++)
        if (space[k].ceiling > z)
            return push(f, tile, i, j, k);
done:
    return st;
}

status fill_water(struct work *w)
{
    status st = OK;
    struct flood f = {.level = stacks_quanta(w->stacks, w->op->level_m)};
    struct spaces_kinds kinds = spaces_kinds(w->tools->table, w->tools->n_materials);
    f.slot = kinds.slot[MATERIAL_WATER];
    TRY(spaces_create(w->stacks, &kinds, &f.spaces));
    for (size_t p = 0; p < w->op->n_points_m; p++)
        TRY(seed(&f, w->op->points_m[p]));
    for (size_t k = 0; k < f.n; k++) {
        struct wet wet = f.queue[k];
        int n;
        TRY(push_neighbours(&f, &wet));
        struct space *s = spaces_at(&f.spaces, wet.i, wet.j, &n) + wet.k;
        uint32_t top = s->ceiling < f.level ? s->ceiling : f.level;
        s->amount[f.slot] = top - ground_of(&f, s);
        w->lo[0] = wet.i < w->lo[0] ? wet.i : w->lo[0];
        w->lo[1] = wet.j < w->lo[1] ? wet.j : w->lo[1];
        w->hi[0] = wet.i > w->hi[0] ? wet.i : w->hi[0];
        w->hi[1] = wet.j > w->hi[1] ? wet.j : w->hi[1];
    }
    TRY(spaces_close(&f.spaces, false, w->stacks, NULL));
done:
    spaces_destroy(&f.spaces);
    free(f.queue);
    return st;
}
