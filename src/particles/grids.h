/* The volumes of a frame in host memory: values at the points of a lattice, of which only the bricks are kept that hold
 * something.
 *
 * Bricks    8^3 samples each. Those of a frame are the same for all of its grids; they are numbered (k ny + j) nx + i, and
 *           kept in that order, so that equal frames are equal bytes. A sample of brick b is at [512 b + 64 z + 8 y + x] of
 *           an array, x, y and z being from 0 to 7; those beyond the lattice hold the background.
 * Background  what samples outside all bricks are: 3 voxels in level sets, 0 otherwise.
 * Inside    bricks that are all inside need not be kept either (BRICK_INSIDE): level sets are -3 voxels there, and every other
 *           grid one value, which is 0 for most, or one for each of them (grid_inside()).
 * Calling sequence   frame_grids_begin(), frame_grids_choose(); then frame_grids_add() and an array for each.
 */
#ifndef HOODOO_GRIDS_H
#define HOODOO_GRIDS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "base/status.h"
#include "job/values.h"

enum { BRICK_SIDE = 8, BRICK_SAMPLES = 512, GRID_BAND = 3 };

/* The slot of a brick that is not kept, being inside. */
#define BRICK_INSIDE UINT32_MAX

enum grid_class { GRID_LEVEL_SET, GRID_FOG, GRID_PLAIN };

/* Sample (i, j, k) lies at origin + (i, j, k) voxel. */
struct grid_lattice {
    int n[3];
    double voxel, origin[3]; /* m */
};

struct grid_bricks {
    int n[3]; /* along the axes; the last ones may reach beyond the lattice */
    size_t count;
    uint32_t *number; /* [count] ascending */
    /* Of each brick of the lattice: its place in `number` and one more; not kept are 0 outside, and BRICK_INSIDE. */
    uint32_t *slot;
};

struct frame_grid {
    const char *name; /* surface, density, stress, ... */
    const char *unit;
    enum grid_class kind;
    int components; /* 0 or 1: a scalar. 3: a vector in the simulator's axes, interleaved */
    float inside;   /* level sets: unused. What samples inside that are not kept hold */
    float *deep;    /* [bricks of the lattice] that for each, or NULL; owned by the frame */
    float *value;   /* [bricks.count * BRICK_SAMPLES * components]; owned by the frame */
};

struct frame_grids {
    struct grid_lattice lattice;
    struct grid_bricks bricks;
    size_t n_grids;
    struct frame_grid grid[VALUES];
};
/* In scalar grids, voxels where `density` is 0 are inactive, except in level sets, whose active voxels are
 * those with |value| < 3 voxels (the background). In vector grids those with a zero vector are. */

/* Bricks a lattice has along the axes; returns how many that are. */
size_t grid_bricks_of(const int n[3], int out[3]);

/* Grids on that lattice, without bricks so far. frame_grids_free(). */
MUST_USE status frame_grids_begin(const struct grid_lattice *lattice, struct frame_grids *out);

/* Keeps these bricks, numbers of them in ascending order: *numbers becomes theirs. */
void frame_grids_choose(struct frame_grids *grids, uint32_t **numbers, size_t n);

/* One more grid, of this value, that is not sampled yet; *out stays where it is. E_OUTPUT: it is there already, or there are as
 * many as there can be. */
MUST_USE status frame_grids_add(struct frame_grids *grids, enum value_id value, struct frame_grid **out);

/* The one of that name, or NULL. */
const struct frame_grid *frame_grid_named(const struct frame_grids *grids, const char *name);

/* Harmless on {0}. */
void frame_grids_free(struct frame_grids *grids);

/* What samples outside the bricks hold. */
static inline float grid_background(const struct frame_grids *grids, const struct frame_grid *grid)
{
    return grid->kind == GRID_LEVEL_SET ? (float)(GRID_BAND * grids->lattice.voxel) : 0;
}

/* The brick of a sample. */
static inline size_t grid_brick(const struct frame_grids *grids, int i, int j, int k)
{
    const int *n = grids->bricks.n;
    return ((size_t)(k / BRICK_SIDE) * (size_t)n[1] + (size_t)(j / BRICK_SIDE)) * (size_t)n[0] +
           (size_t)(i / BRICK_SIDE);
}

/* What those of this brick do, which is all inside. */
static inline float grid_inside(const struct frame_grids *grids, const struct frame_grid *grid, size_t brick)
{
    return grid->kind == GRID_LEVEL_SET ? -grid_background(grids, grid)
           : grid->deep                 ? grid->deep[brick]
                                        : grid->inside;
}

enum { ROW_OUTSIDE = -1, ROW_INSIDE = -2 };

/* Where the samples from (i, j, k) on, along x to the end of their brick, are in an array; if they are not kept, ROW_OUTSIDE or
 * ROW_INSIDE. */
static inline ptrdiff_t grid_row(const struct frame_grids *grids, int i, int j, int k)
{
    const struct grid_bricks *b = &grids->bricks;
    const size_t at = grid_brick(grids, i, j, k);
    if (b->slot[at] == 0 || b->slot[at] == BRICK_INSIDE)
        return b->slot[at] == 0 ? ROW_OUTSIDE : ROW_INSIDE;
    return (ptrdiff_t)(b->slot[at] - 1) * BRICK_SAMPLES +
           ((k % BRICK_SIDE) * BRICK_SIDE + j % BRICK_SIDE) * BRICK_SIDE + i % BRICK_SIDE;
}

/* One sample of a scalar on the frame's lattice. */
static inline float grid_at(const struct frame_grids *grids, const struct frame_grid *grid, int i, int j,
                            int k)
{
    const ptrdiff_t at = grid_row(grids, i, j, k);
    return at >= 0             ? grid->value[at]
           : at == ROW_OUTSIDE ? grid_background(grids, grid)
                               : grid_inside(grids, grid, grid_brick(grids, i, j, k));
}

#endif
