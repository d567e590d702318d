#include "stacks/spaces.h"

#include <stdlib.h>
#include <string.h>

#include "base/memory.h"

enum { TILE_STACKS = STACK_TILE * STACK_TILE };

struct spaces_kinds spaces_kinds(const struct material *table, int n)
{
    struct spaces_kinds k = {0};
    for (int m = 0; m < MATERIALS_MAX; m++)
        k.slot[m] = -1;
    for (int pass = 0; pass < 2; pass++) /* water last */
        for (int m = 0; m < n; m++) {
            if (m == MATERIAL_AIR || (m == MATERIAL_WATER) != pass)
                continue;
            if (m != MATERIAL_WATER && table[m].repose_deg >= 90) {
                k.solid |= 1u << m;
            } else if (k.n < SPACE_LOOSE) {
                k.slot[m] = k.n;
                k.material[k.n++] = (uint32_t)m;
            }
        }
    return k;
}

status spaces_create(const struct stacks *stacks, const struct spaces_kinds *kinds, struct spaces *out)
{
    *out = (struct spaces){.stacks = stacks, .kinds = *kinds};
    return memory_alloc((size_t)stacks->tiles[0] * (size_t)stacks->tiles[1], sizeof *out->tile, "spaces",
                        &out->tile);
}

void spaces_destroy(struct spaces *s)
{
    size_t n = s->tile ? (size_t)s->stacks->tiles[0] * (size_t)s->stacks->tiles[1] : 0;
    for (size_t t = 0; t < n; t++) {
        free(s->tile[t].space);
        free(s->tile[t].mark);
    }
    free(s->tile);
    *s = (struct spaces){0};
}

/* Counts the spaces of a stack, and lists them in `out` if it is not NULL. */
static uint32_t list_spaces(const struct spaces_kinds *kinds, const uint32_t *layer, size_t n,
                            struct space *out)
{
    uint32_t count = 0, bottom = 0;
    bool in_space = false;
    for (size_t k = 0; k <= n; k++) {
        uint32_t top = k < n ? layer_top(layer[k]) : (uint32_t)STACK_TOP;
        uint32_t material = k < n ? layer_material(layer[k]) : (uint32_t)MATERIAL_AIR;
        if (kinds->solid >> material & 1) {
            in_space = false;
        } else {
            if (!in_space) {
                if (out)
                    out[count] = (struct space){.floor = bottom};
                count++;
            }
            in_space = true;
            if (out) {
                out[count - 1].ceiling = top;
                if (kinds->slot[material] >= 0)
                    out[count - 1].amount[kinds->slot[material]] += top - bottom;
            }
        }
        bottom = top;
    }
    return count;
}

static status open_tile(struct spaces *s, int ti, int tj)
{
    status st = OK;
    struct space_tile *t = &s->tile[(size_t)tj * (size_t)s->stacks->tiles[0] + (size_t)ti];
    if (t->open)
        return OK;
    for (int pass = 0; pass < 2; pass++) {
        for (int slot = 0; slot < TILE_STACKS; slot++) {
            int i = ti * STACK_TILE + slot % STACK_TILE, j = tj * STACK_TILE + slot / STACK_TILE;
            bool there = i < s->stacks->n[0] && j < s->stacks->n[1];
            size_t n = 0;
            const uint32_t *layer = there ? stacks_column(s->stacks, i, j, &n) : NULL;
            uint32_t count =
                there ? list_spaces(&s->kinds, layer, n, pass ? t->space + t->first[slot] : NULL) : 0;
            t->first[slot + 1] = t->first[slot] + count;
        }
        if (pass == 0) {
            TRY(memory_alloc(t->first[TILE_STACKS], sizeof *t->space, "spaces", &t->space));
            TRY(memory_alloc(t->first[TILE_STACKS], 1, "spaces", &t->mark));
        }
    }
    t->open = true;
done:
    return st;
}

status spaces_tile(struct spaces *s, int i, int j, struct space_tile **out)
{
    *out = &s->tile[(size_t)(j / STACK_TILE) * (size_t)s->stacks->tiles[0] + (size_t)(i / STACK_TILE)];
    return (*out)->open ? OK : open_tile(s, i / STACK_TILE, j / STACK_TILE);
}

status spaces_open(struct spaces *s, const int lo[2], const int hi[2])
{
    status st = OK;
    int first[2], last[2];
    for (int a = 0; a < 2; a++) {
        first[a] = (lo[a] > 0 ? lo[a] : 0) / STACK_TILE;
        last[a] = (hi[a] < s->stacks->n[a] ? hi[a] : s->stacks->n[a] - 1) / STACK_TILE;
    }
    int across = last[0] - first[0] + 1, n = across * (last[1] - first[1] + 1);
#pragma omp parallel for schedule(dynamic) if (n > 4)
    for (int k = 0; k < n; k++)
        if (open_tile(s, first[0] + k % across, first[1] + k / across) != OK)
#pragma omp atomic write
            st = E_MEMORY;
    return st == OK ? OK : fail(st, "no memory for the spaces of %d tiles of stacks", n);
}

/* ---- back into stacks */

struct close {
    const struct spaces *s;
    bool all;
    uint64_t lost;
};

/* Adds the loose layers of a space. */
static status add_loose(const struct spaces *s, const struct space *space, struct column *c, uint64_t *lost)
{
    status st = OK;
    uint32_t top = space->floor;
    for (int k = 0; k < s->kinds.n; k++) {
        uint32_t height = space->ceiling - top, amount = space->amount[k];
        if (amount > height) { /* only water: stabilise() never overfills a space with anything else */
            *lost += amount - height;
            amount = height;
        }
        top += amount;
        TRY(column_add(c, top, s->kinds.material[k]));
    }
done:
    return st;
}

static status close_column(void *user, int i, int j, struct column *c)
{
    status st = OK;
    struct close *close = user;
    const struct spaces *s = close->s;
    const struct space_tile *tile =
        &s->tile[(size_t)(j / STACK_TILE) * (size_t)s->stacks->tiles[0] + (size_t)(i / STACK_TILE)];
    if (!tile->open || !(close->all || tile->changed))
        return OK;
    int n, at = 0;
    const struct space *space = spaces_at(s, i, j, &n);
    size_t n_layers;
    uint64_t lost = 0;
    /* The stack as it was when opened; c may come from a copy that has been edited since. */
    const uint32_t *layer = stacks_column(s->stacks, i, j, &n_layers);
    c->n = 0;
    for (size_t k = 0; k <= n_layers; k++) {
        uint32_t bottom = k ? layer_top(layer[k - 1]) : 0;
        uint32_t top = k < n_layers ? layer_top(layer[k]) : (uint32_t)STACK_TOP;
        uint32_t material = k < n_layers ? layer_material(layer[k]) : (uint32_t)MATERIAL_AIR;
        if (s->kinds.solid >> material & 1) {
            TRY(column_add(c, bottom, MATERIAL_AIR));
            TRY(column_add(c, top, material));
        } else if (at < n && bottom == space[at].floor) {
            TRY(add_loose(s, &space[at++], c, &lost));
        }
    }
    if (lost)
#pragma omp atomic
        close->lost += lost;
done:
    return st;
}

status spaces_close(const struct spaces *s, bool all, struct stacks *out, uint64_t *lost)
{
    status st = OK;
    struct close close = {.all = all};
    struct stacks before = {0};
    /* Tiles of `out` may be shared with those the spaces were opened from: keep these alive while they are read. */
    TRY(stacks_copy(s->stacks, &before));
    struct spaces from = *s;
    from.stacks = &before;
    close.s = &from;
    int lo[2] = {INT32_MAX, INT32_MAX}, hi[2] = {-1, -1};
    for (int tj = 0; tj < s->stacks->tiles[1]; tj++)
        for (int ti = 0; ti < s->stacks->tiles[0]; ti++) {
            const struct space_tile *t = &s->tile[(size_t)tj * (size_t)s->stacks->tiles[0] + (size_t)ti];
            if (!t->open || !(all || t->changed))
                continue;
            lo[0] = ti < lo[0] ? ti : lo[0];
            lo[1] = tj < lo[1] ? tj : lo[1];
            hi[0] = ti > hi[0] ? ti : hi[0];
            hi[1] = tj > hi[1] ? tj : hi[1];
        }
    if (hi[0] >= 0)
        TRY(stacks_edit(
            out, (const int[]){lo[0] * STACK_TILE, lo[1] * STACK_TILE},
            (const int[]){hi[0] * STACK_TILE + STACK_TILE - 1, hi[1] * STACK_TILE + STACK_TILE - 1},
            close_column, &close));
done:
    stacks_destroy(&before);
    if (lost)
        *lost = close.lost;
    return st;
}
