#include "stacks/stacks.h"

#include <math.h>
#include <stdatomic.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"

enum { TILE_STACKS = STACK_TILE * STACK_TILE };

struct stack_tile {
    atomic_uint owners;
    uint32_t first[TILE_STACKS + 1];
    uint32_t layer[];
};

static size_t tile_count(const struct stacks *s)
{
    return (size_t)s->tiles[0] * (size_t)s->tiles[1];
}

static void tile_release(struct stack_tile *t)
{
    if (t && atomic_fetch_sub(&t->owners, 1) == 1)
        free(t);
}

/* A tile of these layers; NULL if there are none. */
static status tile_create(const uint32_t first[TILE_STACKS + 1], const uint32_t *layer,
                          struct stack_tile **out)
{
    size_t n = first[TILE_STACKS];
    *out = NULL;
    if (n == 0)
        return OK;
    status st = memory_alloc(1, sizeof **out + n * sizeof *layer, "stacks", out);
    if (st != OK)
        return st;
    atomic_init(&(*out)->owners, 1);
    memcpy((*out)->first, first, sizeof(*out)->first);
    memcpy((*out)->layer, layer, n * sizeof *layer);
    return OK;
}

status stacks_create(const int n[2], double cell, double height, struct stacks *out)
{
    *out = (struct stacks){.n = {n[0], n[1]}, .cell = cell, .quantum = height / STACK_TOP};
    if (n[0] < 1 || n[1] < 1 || (int64_t)n[0] * n[1] > STACKS_MAX)
        return fail(E_USAGE, "arches: %d x %d stacks, but the limit is %d: raise arches.cell_m", n[0], n[1],
                    STACKS_MAX);
    for (int a = 0; a < 2; a++)
        out->tiles[a] = (n[a] + STACK_TILE - 1) / STACK_TILE;
    return memory_alloc(tile_count(out), sizeof(struct stack_tile *), "stacks", &out->tile);
}

void stacks_destroy(struct stacks *s)
{
    for (size_t t = 0; s->tile && t < tile_count(s); t++)
        tile_release(s->tile[t]);
    free(s->tile);
    *s = (struct stacks){0};
}

status stacks_copy(const struct stacks *s, struct stacks *out)
{
    struct stacks copy = *s;
    status st = memory_alloc(tile_count(s), sizeof(struct stack_tile *), "stacks", &copy.tile);
    if (st != OK)
        return st;
    for (size_t t = 0; t < tile_count(s); t++) {
        copy.tile[t] = s->tile[t];
        if (copy.tile[t])
            atomic_fetch_add(&copy.tile[t]->owners, 1);
    }
    *out = copy;
    return OK;
}

static const uint32_t *tile_column(const struct stack_tile *t, int slot, size_t *n)
{
    *n = t ? t->first[slot + 1] - t->first[slot] : 0;
    return t ? t->layer + t->first[slot] : NULL;
}

const uint32_t *stacks_column(const struct stacks *s, int i, int j, size_t *n)
{
    const struct stack_tile *t =
        s->tile[(size_t)(j / STACK_TILE) * (size_t)s->tiles[0] + (size_t)(i / STACK_TILE)];
    return tile_column(t, j % STACK_TILE * STACK_TILE + i % STACK_TILE, n);
}

/* ---- edits */

struct edit {
    const struct stacks *s;
    int lo[2], hi[2];
    column_edit edit;
    void *user;
};

/* Buffers of one thread. */
struct workspace {
    struct column column;
    uint32_t first[TILE_STACKS + 1];
    uint32_t *layer;
    size_t capacity;
};

static status append(struct workspace *w, int slot, const uint32_t *layer, size_t n)
{
    size_t at = w->first[slot];
    status st = memory_grow(&w->layer, &w->capacity, at + n, sizeof *layer, "stacks");
    if (st != OK)
        return st;
    if (n)
        memcpy(w->layer + at, layer, n * sizeof *layer);
    w->first[slot + 1] = (uint32_t)(at + n);
    return OK;
}

/* Edits tile t. *out: the new tile, or the old one if nothing has changed. */
static status edit_tile(const struct edit *e, size_t t, struct workspace *w, struct stack_tile **out)
{
    status st = OK;
    struct stack_tile *old = e->s->tile[t];
    int corner[2] = {(int)(t % (size_t)e->s->tiles[0]) * STACK_TILE,
                     (int)(t / (size_t)e->s->tiles[0]) * STACK_TILE};
    bool changed = false;
    w->first[0] = 0;
    for (int slot = 0; slot < TILE_STACKS; slot++) {
        int i = corner[0] + slot % STACK_TILE, j = corner[1] + slot / STACK_TILE;
        size_t n;
        const uint32_t *layer = tile_column(old, slot, &n);
        if (i < e->lo[0] || i > e->hi[0] || j < e->lo[1] || j > e->hi[1]) {
            TRY(append(w, slot, layer, n));
            continue;
        }
        TRY(column_copy(&w->column, layer, n));
        TRY(e->edit(e->user, i, j, &w->column));
        changed |= w->column.n != n || (n && memcmp(w->column.layer, layer, n * sizeof *layer) != 0);
        TRY(append(w, slot, w->column.layer, w->column.n));
    }
    *out = old;
    if (changed)
        TRY(tile_create(w->first, w->layer, out));
done:
    return st;
}

status stacks_edit(struct stacks *s, const int lo[2], const int hi[2], column_edit edit, void *user)
{
    status st = OK;
    char why[2048] = "";
    struct edit e = {.s = s, .edit = edit, .user = user};
    struct stack_tile **made = NULL;
    for (int a = 0; a < 2; a++) {
        e.lo[a] = lo[a] > 0 ? lo[a] : 0;
        e.hi[a] = hi[a] < s->n[a] ? hi[a] : s->n[a] - 1;
        if (e.lo[a] > e.hi[a])
            return OK;
    }
    int first[2] = {e.lo[0] / STACK_TILE, e.lo[1] / STACK_TILE};
    int across = e.hi[0] / STACK_TILE - first[0] + 1, down = e.hi[1] / STACK_TILE - first[1] + 1;
    TRY(memory_alloc((size_t)across * (size_t)down, sizeof(struct stack_tile *), "stacks", &made));
#pragma omp parallel if (across * down > 1)
    {
        struct workspace w = {0};
#pragma omp for schedule(dynamic)
        for (int k = 0; k < across * down; k++) {
            size_t t =
                (size_t)(first[1] + k / across) * (size_t)s->tiles[0] + (size_t)(first[0] + k % across);
            status own = edit_tile(&e, t, &w, &made[k]);
            if (own != OK) {
                made[k] = s->tile[t];
#pragma omp critical
                if (st == OK) {
                    st = own;
                    snprintf(why, sizeof why, "%s", status_message());
                }
            }
        }
        column_free(&w.column);
        free(w.layer);
    }
    for (int k = 0; k < across * down; k++) {
        size_t t = (size_t)(first[1] + k / across) * (size_t)s->tiles[0] + (size_t)(first[0] + k % across);
        if (made[k] == s->tile[t])
            continue;
        if (st == OK) {
            tile_release(s->tile[t]);
            s->tile[t] = made[k];
        } else {
            tile_release(made[k]);
        }
    }
    if (st != OK)
        fail(st, "%s", why);
done:
    free(made);
    return st;
}

/* ---- sums */

void stacks_amounts(const struct stacks *s, uint64_t amount[MATERIALS_MAX])
{
    memset(amount, 0, MATERIALS_MAX * sizeof *amount);
    for (size_t t = 0; t < tile_count(s); t++)
        for (int slot = 0; s->tile[t] && slot < TILE_STACKS; slot++) {
            size_t n;
            const uint32_t *layer = tile_column(s->tile[t], slot, &n);
            column_amounts(layer, n, amount);
        }
}

size_t stacks_bytes(const struct stacks *s)
{
    size_t bytes = sizeof *s + tile_count(s) * sizeof *s->tile;
    for (size_t t = 0; t < tile_count(s); t++)
        if (s->tile[t])
            bytes += sizeof *s->tile[t] + s->tile[t]->first[TILE_STACKS] * sizeof(uint32_t);
    return bytes;
}

uint32_t stacks_quanta(const struct stacks *s, double z)
{
    double quanta = round(z / s->quantum);
    return !(quanta > 0) ? 0 : quanta < STACK_TOP ? (uint32_t)quanta : (uint32_t)STACK_TOP;
}

/* ---- flat arrays */

size_t stacks_layers(const struct stacks *s)
{
    size_t n = 0;
    for (size_t t = 0; t < tile_count(s); t++)
        n += s->tile[t] ? s->tile[t]->first[TILE_STACKS] : 0;
    return n;
}

void stacks_pack(const struct stacks *s, uint32_t *count, uint32_t *layer)
{
    for (int j = 0; j < s->n[1]; j++)
        for (int i = 0; i < s->n[0]; i++) {
            size_t n;
            const uint32_t *from = stacks_column(s, i, j, &n);
            *count++ = (uint32_t)n;
            if (n)
                memcpy(layer, from, n * sizeof *from);
            layer += n;
        }
}

/* Tops ascend, neighbours differ in material, and the last layer is not air. */
static bool is_stack(const uint32_t *layer, size_t n)
{
    for (size_t i = 0; i < n; i++) {
        uint32_t below = i ? layer_top(layer[i - 1]) : 0;
        if (layer_top(layer[i]) <= below || (i && layer_material(layer[i]) == layer_material(layer[i - 1])))
            return false;
    }
    return n == 0 || layer_material(layer[n - 1]) != MATERIAL_AIR;
}

struct unpack {
    const struct stacks *s;
    const uint32_t *count, *layer;
    const size_t *first; /* [stacks]: index of the first layer */
};

static status unpack_column(void *user, int i, int j, struct column *c)
{
    const struct unpack *u = user;
    size_t at = (size_t)j * (size_t)u->s->n[0] + (size_t)i;
    return column_copy(c, u->layer + u->first[at], u->count[at]);
}

status stacks_unpack(struct stacks *s, const uint32_t *count, const uint32_t *layer, size_t n_layers)
{
    status st = OK;
    size_t *first = NULL, n = (size_t)s->n[0] * (size_t)s->n[1], sum = 0;
    TRY(memory_alloc(n, sizeof *first, "stacks", &first));
    for (size_t k = 0; k < n; k++) {
        first[k] = sum;
        if (count[k] > n_layers - sum || !is_stack(layer + sum, count[k])) {
            st = fail(E_INPUT, "stack (%zu, %zu) is damaged", k % (size_t)s->n[0], k / (size_t)s->n[0]);
            goto done;
        }
        sum += count[k];
    }
    if (sum != n_layers) {
        st = fail(E_INPUT, "there are %zu layers, but the stacks have %zu", n_layers, sum);
        goto done;
    }
    struct unpack u = {s, count, layer, first};
    TRY(stacks_edit(s, (const int[2]){0, 0}, s->n, unpack_column, &u));
done:
    free(first);
    return st;
}
