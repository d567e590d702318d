/* Terrain as a grid of stacks: each cell has its layers of material, from the floor up (Arches 3.2).
 *
 * Shape    n[0] x n[1] stacks; stack (i, j) covers [i cell, (i+1) cell] x [j cell, (j+1) cell], m. Heights are integer numbers of quanta
 *          (column.h) of `quantum` metres.
 * Memory   Layers are packed in tiles of 32 x 32 stacks: four bytes per layer and four per stack. Air on top is not stored.
 * Copies   stacks_copy() shares tiles; an edit replaces only the tiles that it changes (copy on write).
 * Threads  Different copies may be edited concurrently; each copy by one thread.
 */
#ifndef HOODOO_STACKS_H
#define HOODOO_STACKS_H

#include <stddef.h>
#include <stdint.h>

#include "stacks/column.h"
#include "stacks/material.h"

enum { STACK_TILE = 32, STACKS_MAX = 1 << 26 };

struct stack_tile;

struct stacks {
    int n[2], tiles[2];
    double cell, quantum; /* m */
    struct stack_tile **tile;
};

/* Empty stacks of n cells, for heights up to `height` metres. E_USAGE: more than STACKS_MAX. E_MEMORY. */
MUST_USE status stacks_create(const int n[2], double cell, double height, struct stacks *out);
void stacks_destroy(struct stacks *s);

/* *out shares all tiles with s until either is edited. E_MEMORY. */
MUST_USE status stacks_copy(const struct stacks *s, struct stacks *out);

/* The *n layers of stack (i, j) of the grid; valid until the next edit. */
const uint32_t *stacks_column(const struct stacks *s, int i, int j, size_t *n);

/* Edits one stack. It is called once for each stack, in any order, from several threads, and must not read what another call writes. */
typedef status (*column_edit)(void *user, int i, int j, struct column *c);

/* Calls `edit` for the stacks lo..hi (inclusive, clamped to the grid). On an error, of `edit` too, s is unchanged. */
MUST_USE status stacks_edit(struct stacks *s, const int lo[2], const int hi[2], column_edit edit, void *user);

/* The quanta of each material in all stacks; the volume of a quantum is cell^2 * quantum. Air: only below other layers. */
void stacks_amounts(const struct stacks *s, uint64_t amount[MATERIALS_MAX]);

/* The memory of s, bytes, shared tiles included. */
size_t stacks_bytes(const struct stacks *s);

/* The height z, m, in quanta: rounded and clamped to 0..STACK_TOP. */
uint32_t stacks_quanta(const struct stacks *s, double z);

/* ---- as flat arrays: count[n[1]][n[0]], the number of layers of each stack; and the layers of all stacks in that order */

size_t stacks_layers(const struct stacks *s);
void stacks_pack(const struct stacks *s, uint32_t *count, uint32_t *layer);

/* Replaces the stacks of s, which has the right size. E_INPUT: the arrays are not valid stacks. E_MEMORY. */
MUST_USE status stacks_unpack(struct stacks *s, const uint32_t *count, const uint32_t *layer,
                              size_t n_layers);

#endif
