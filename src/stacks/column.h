/* One stack of layers while it is edited: words bottom up, each a layer's top and its material.
 *
 * Heights are whole numbers of quanta, 0 to STACK_TOP; a layer reaches from the top of the one below (0 for
 * the first) to its own. Above the last layer is air. Whole numbers make moving material exact: what one
 * stack loses another gains, to the last bit. 28 bits are finer than a float over most of the height.
 */
#ifndef HOODOO_COLUMN_H
#define HOODOO_COLUMN_H

#include <stddef.h>
#include <stdint.h>

#include "base/status.h"

enum { MATERIAL_BITS = 4, MATERIALS_MAX = 1 << MATERIAL_BITS };
enum { STACK_TOP = (1 << (32 - MATERIAL_BITS)) - 1 };

static inline uint32_t layer_of(uint32_t top, uint32_t material)
{
    return top << MATERIAL_BITS | material;
}
static inline uint32_t layer_top(uint32_t layer)
{
    return layer >> MATERIAL_BITS;
}
static inline uint32_t layer_material(uint32_t layer)
{
    return layer & (MATERIALS_MAX - 1);
}

struct column {
    uint32_t *layer;
    size_t n, capacity;
    uint32_t *spare; /* the other half of every edit */
    size_t spare_capacity;
};

void column_free(struct column *c);

/* Becomes a copy of n layers. */
MUST_USE status column_copy(struct column *c, const uint32_t *layer, size_t n);

/* Adds a layer on top; nothing where `top` is not above the last one's. Merges equal neighbours. */
MUST_USE status column_add(struct column *c, uint32_t top, uint32_t material);

/* [lo, hi) becomes `material`. */
MUST_USE status column_put(struct column *c, uint32_t lo, uint32_t hi, uint32_t material);

/* The materials of `set` (a bit each) in [lo, hi) become `material`. */
MUST_USE status column_change(struct column *c, uint32_t lo, uint32_t hi, uint32_t set, uint32_t material);

/* Quanta of every material; air only below the last layer. */
void column_amounts(const uint32_t *layer, size_t n, uint64_t amount[MATERIALS_MAX]);

/* The material at height z; air above. */
uint32_t column_at(const uint32_t *layer, size_t n, uint32_t z);

#endif
