/* Terrain as a grid of stacks: for each cell the layers of material over it, from the floor up (Arches 3.2).
 *
 * Shape    n[0] x n[1] stacks, each over a square of `cell` metres: stack (i, j) covers [i cell, (i+1) cell]
 *          and so on. Heights are whole quanta (column.h); `quantum` metres each.
 * Memory   Layers lie packed in tiles of 32 x 32 stacks: four bytes a layer and four a stack, whatever the
 *          height. Air on top is not stored.
 * Copies   stacks_copy() shares the tiles; an edit makes anew only the tiles that it changes.
 * Threads  Different copies may be edited at once; one copy by one thread.
 */
#ifndef HOODOO_STACKS_H
#define HOODOO_STACKS_H

#include <stddef.h>
#include <stdint.h>

#include "stacks/column.h"
#include "stacks/material.h"

enum { STACK_TILE = 32, STACKS_MOST = 1 << 26 };

struct stack_tile;

struct stacks {
    int n[2], tiles[2];
    double cell, quantum; /* m */
    struct stack_tile **tile;
};

/* Empty stacks over n cells, up to `height` metres. E_USAGE: more than STACKS_MOST. */
MUST_USE status stacks_create(const int n[2], double cell, double height, struct stacks *out);
void stacks_destroy(struct stacks *s);

/* *out shares everything with s until either is edited. */
MUST_USE status stacks_copy(const struct stacks *s, struct stacks *out);

/* The layers of stack (i, j), which is inside; until the next edit. */
const uint32_t *stacks_column(const struct stacks *s, int i, int j, size_t *n);

/* Changes one stack. It is called once for each in any order, from several threads, and reads nothing that
 * another call writes. */
typedef status (*column_edit)(void *user, int i, int j, struct column *c);

/* Edits the stacks lo..hi (inclusive, cut to the grid). On an error nothing has changed. */
MUST_USE status stacks_edit(struct stacks *s, const int lo[2], const int hi[2], column_edit edit, void *user);

/* Quanta of every material in all stacks; a quantum's volume is cell^2 * quantum. Air: below the tops. */
void stacks_amounts(const struct stacks *s, uint64_t amount[MATERIALS_MAX]);

/* Bytes held by s alone, were nothing shared. */
size_t stacks_bytes(const struct stacks *s);

/* Height in quanta, within 0..STACK_TOP, rounded. */
uint32_t stacks_quanta(const struct stacks *s, double z);

/* ---- as flat arrays: layers of all stacks one after the other, row by row, and how many each has */

size_t stacks_layers(const struct stacks *s);
void stacks_pack(const struct stacks *s, uint32_t *count, uint32_t *layer);

/* Into s, which has the size. E_INPUT with what is wrong if the arrays are no stacks. */
MUST_USE status stacks_unpack(struct stacks *s, const uint32_t *count, const uint32_t *layer,
                              size_t n_layers);

#endif
