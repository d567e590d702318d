#include "stacks/column.h"

#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "stacks/material.h"

void column_free(struct column *c)
{
    free(c->layer);
    free(c->spare);
    *c = (struct column){0};
}

status column_copy(struct column *c, const uint32_t *layer, size_t n)
{
    status st = memory_grow(&c->layer, &c->capacity, n, sizeof *c->layer, "a stack");
    if (st != OK)
        return st;
    if (n)
        memcpy(c->layer, layer, n * sizeof *layer);
    c->n = n;
    return OK;
}

static uint32_t top_of(const struct column *c)
{
    return c->n ? layer_top(c->layer[c->n - 1]) : 0;
}

status column_add(struct column *c, uint32_t top, uint32_t material)
{
    if (top <= top_of(c))
        return OK;
    if (c->n && layer_material(c->layer[c->n - 1]) == material) {
        c->layer[c->n - 1] = layer_of(top, material);
        return OK;
    }
    status st = memory_grow(&c->layer, &c->capacity, c->n + 1, sizeof *c->layer, "a stack");
    if (st == OK)
        c->layer[c->n++] = layer_of(top, material);
    return st;
}

/* Moves the layers to the spare buffer and empties c, which the caller refills from *old. */
static status begin_edit(struct column *c, const uint32_t **old, size_t *n)
{
    status st = memory_grow(&c->spare, &c->spare_capacity, c->capacity, sizeof *c->spare, "a stack");
    if (st != OK)
        return st;
    uint32_t *layer = c->layer;
    size_t capacity = c->capacity;
    c->layer = c->spare;
    c->capacity = c->spare_capacity;
    c->spare = layer;
    c->spare_capacity = capacity;
    *old = layer;
    *n = c->n;
    c->n = 0;
    return OK;
}

/* Removes air on top, which is not stored. */
static void end_edit(struct column *c)
{
    while (c->n && layer_material(c->layer[c->n - 1]) == MATERIAL_AIR)
        c->n--;
}

status column_replace(struct column *c, uint32_t lo, uint32_t hi, uint32_t set, uint32_t material)
{
    status st = OK;
    const uint32_t *old = NULL;
    size_t n = 0;
    uint32_t bottom = 0;
    if (hi > STACK_TOP)
        hi = STACK_TOP;
    if (lo >= hi)
        return OK;
    TRY(begin_edit(c, &old, &n));
    for (size_t i = 0; i <= n && bottom < STACK_TOP; i++) {
        uint32_t top = i < n ? layer_top(old[i]) : STACK_TOP;
        uint32_t own = i < n ? layer_material(old[i]) : (uint32_t)MATERIAL_AIR;
        if (set >> own & 1 && bottom < hi && top > lo) {
            TRY(column_add(c, lo, own)); /* adds nothing if lo is below this layer */
            TRY(column_add(c, hi < top ? hi : top, material));
        }
        TRY(column_add(c, top, own));
        bottom = top;
    }
    end_edit(c);
done:
    return st;
}

status column_set(struct column *c, uint32_t lo, uint32_t hi, uint32_t material)
{
    return column_replace(c, lo, hi, UINT32_MAX, material);
}

void column_amounts(const uint32_t *layer, size_t n, uint64_t amount[MATERIALS_MAX])
{
    uint32_t bottom = 0;
    for (size_t i = 0; i < n; i++) {
        amount[layer_material(layer[i])] += layer_top(layer[i]) - bottom;
        bottom = layer_top(layer[i]);
    }
}

uint32_t column_at(const uint32_t *layer, size_t n, uint32_t z)
{
    for (size_t i = 0; i < n; i++)
        if (z < layer_top(layer[i]))
            return layer_material(layer[i]);
    return MATERIAL_AIR;
}
