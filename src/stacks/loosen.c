#include "stacks/loosen.h"

#include <stdbool.h>
#include <stdlib.h>

#include "base/memory.h"

/* A run of adjacent solid layers in a stack. Pieces are union-find trees of runs; the floor is item 0. */
struct piece {
    uint32_t lo, hi; /* quanta */
    uint32_t parent;
};

struct pieces {
    const struct stacks *stacks;
    uint32_t solid;
    size_t *first; /* [stacks + 1]: each stack's first run in `item` */
    struct piece *item;
};

static uint32_t root_of(struct piece *item, uint32_t at)
{
    while (item[at].parent != at) {
        item[at].parent = item[item[at].parent].parent;
        at = item[at].parent;
    }
    return at;
}

/* The smaller number becomes the root, so that the floor is always a root. */
static void join(struct piece *item, uint32_t a, uint32_t b)
{
    a = root_of(item, a);
    b = root_of(item, b);
    if (a < b)
        item[b].parent = a;
    else
        item[a].parent = b;
}

/* Counts the solid runs of a stack, and if `item` is not NULL lists them there from `number` on. */
static uint32_t list_runs(const struct pieces *p, int i, int j, uint32_t number)
{
    const uint32_t supporting = ~(1u << MATERIAL_AIR | 1u << MATERIAL_WATER);
    size_t n;
    const uint32_t *layer = stacks_column(p->stacks, i, j, &n);
    uint32_t count = 0, bottom = 0, below = 0; /* `below`: the last run */
    bool supported = true, in_run = false;
    for (size_t k = 0; k < n; k++) {
        uint32_t kind = 1u << layer_material(layer[k]), top = layer_top(layer[k]);
        if (!(p->solid & kind)) {
            in_run = false;
            supported = supported && (supporting & kind);
        } else if (in_run) {
            if (p->item)
                p->item[below].hi = top;
        } else {
            uint32_t own = number + count++;
            if (p->item) {
                p->item[own] = (struct piece){bottom, top, own};
                if (supported)
                    join(p->item, below, own);
            }
            below = own;
            in_run = supported = true;
        }
        bottom = top;
    }
    return count;
}

/* Joins overlapping runs of two neighbouring stacks, in one pass upwards through both. */
static void join_stacks(const struct pieces *p, size_t one, size_t other)
{
    size_t a = p->first[one], b = p->first[other];
    while (a < p->first[one + 1] && b < p->first[other + 1]) {
        const struct piece *x = &p->item[a], *y = &p->item[b];
        if (x->lo < y->hi && y->lo < x->hi)
            join(p->item, (uint32_t)a, (uint32_t)b);
        if (x->hi < y->hi)
            a++;
        else
            b++;
    }
}

static status find_pieces(struct pieces *p)
{
    status st = OK;
    const int *n = p->stacks->n;
    const size_t n_stacks = (size_t)n[0] * (size_t)n[1];
    size_t count = 1, s = 0;
    TRY(memory_alloc(n_stacks + 1, sizeof *p->first, "pieces", &p->first));
    for (int j = 0; j < n[1]; j++)
        for (int i = 0; i < n[0]; i++) {
            p->first[s++] = count;
            count += list_runs(p, i, j, 0);
        }
    p->first[s] = count;
    if (count > UINT32_MAX) {
        st = fail(E_MEMORY, "the terrain has %zu solid layers, more than 2^32: raise arches.cell_m", count);
        goto done;
    }
    TRY(memory_alloc(count, sizeof *p->item, "pieces", &p->item));
    for (size_t at = 0; at < n_stacks; at++) {
        int i = (int)(at % (size_t)n[0]), j = (int)(at / (size_t)n[0]);
        list_runs(p, i, j, (uint32_t)p->first[at]);
        if (i > 0)
            join_stacks(p, at - 1, at);
        if (j > 0)
            join_stacks(p, at - (size_t)n[0], at);
    }
done:
    return st;
}

static status loosen_stack(void *user, int i, int j, struct column *c)
{
    status st = OK;
    const struct pieces *p = user;
    size_t at = (size_t)j * (size_t)p->stacks->n[0] + (size_t)i;
    for (size_t k = p->first[at]; k < p->first[at + 1]; k++)
        if (p->item[k].parent != 0)
            TRY(column_replace(c, p->item[k].lo, p->item[k].hi, p->solid, MATERIAL_ROCK));
done:
    return st;
}

status loosen(struct stacks *s, uint32_t solid, int lo[2], int hi[2])
{
    status st = OK;
    struct pieces p = {.stacks = s, .solid = solid};
    for (int a = 0; a < 2; a++) {
        lo[a] = s->n[a];
        hi[a] = -1;
    }
    TRY(find_pieces(&p));
    for (int j = 0; j < s->n[1]; j++)
        for (int i = 0; i < s->n[0]; i++) {
            size_t at = (size_t)j * (size_t)s->n[0] + (size_t)i;
            for (size_t k = p.first[at]; k < p.first[at + 1]; k++) {
                /* Flatten all trees, for loosen_stack() runs on several threads. */
                p.item[k].parent = root_of(p.item, (uint32_t)k);
                if (p.item[k].parent == 0)
                    continue;
                lo[0] = i < lo[0] ? i : lo[0];
                hi[0] = i > hi[0] ? i : hi[0];
                lo[1] = j < lo[1] ? j : lo[1];
                hi[1] = j > hi[1] ? j : hi[1];
            }
        }
    if (lo[0] <= hi[0])
        TRY(stacks_edit(s, lo, hi, loosen_stack, &p));
done:
    free(p.first);
    free(p.item);
    return st;
}
