/* A stack of layers while it is edited, bottom up, each packed into 32 bits as its top and its material.
 *
 * Heights are integer numbers of quanta, 0 to STACK_TOP. A layer extends from the top of the one below it (0 for the first) to its own
 * top; above the last one is air. With integers the transport of material is exact: what one stack loses another gains. 28 bits are
 * finer than a float over most of the height.
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
    uint32_t *spare; /* holds the old layers during an edit */
    size_t spare_capacity;
};

void column_free(struct column *c);

/* Replaces c's layers by a copy of these. The functions below fail with E_MEMORY only. */
MUST_USE status column_copy(struct column *c, const uint32_t *layer, size_t n);

/* Adds a layer on top, unless `top` is not above the last one's. Merges it with the last one if the material is the same. */
MUST_USE status column_add(struct column *c, uint32_t top, uint32_t material);

/* Sets [lo, hi) to `material`. */
MUST_USE status column_set(struct column *c, uint32_t lo, uint32_t hi, uint32_t material);

/* Replaces the materials of `set` (a bit each) in [lo, hi) by `material`. */
MUST_USE status column_replace(struct column *c, uint32_t lo, uint32_t hi, uint32_t set, uint32_t material);

/* Adds the quanta of each material to amount[]; air only below the last layer. */
void column_amounts(const uint32_t *layer, size_t n, uint64_t amount[MATERIALS_MAX]);

/* The material at height z; air above the last layer. */
uint32_t column_at(const uint32_t *layer, size_t n, uint32_t z);

#endif
