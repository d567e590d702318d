/* The volumes of a frame in host memory: values at the points of a lattice, stored sparsely in bricks.
 *
 * Bricks      of 8^3 samples. All grids of a frame have the same bricks, numbered (k ny + j) nx + i and stored in that order, so that
 *             equal frames are equal bytes. Sample (x, y, z) of the brick in slot b, 0..7 each, is at [512 b + 64 z + 8 y + x] of an
 *             array. Samples beyond the lattice have the background value.
 * Background  the value of samples outside of all bricks: 3 voxels in level sets, otherwise 0.
 * Inside      bricks that are completely inside need not be stored (BRICK_INSIDE). Their value is -3 voxels in level sets; in other grids
 *             one value for all (0 for most), or one per brick (grid_inside()).
 * Calling sequence   frame_grids_begin(), frame_grids_choose(); then frame_grids_add() and an array for each grid.
 */
#ifndef HOODOO_GRIDS_H
#define HOODOO_GRIDS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "base/status.h"
#include "job/values.h"

enum { BRICK_SIDE = 8, BRICK_SAMPLES = 512, GRID_BAND = 3 };

/* The slot of a brick that is not stored because it is completely inside. */
#define BRICK_INSIDE UINT32_MAX

enum grid_class { GRID_LEVEL_SET, GRID_FOG, GRID_PLAIN };

/* Sample (i, j, k) is at origin + (i, j, k) voxel. */
struct grid_lattice {
    int n[3];
    double voxel, origin[3]; /* m */
};

struct grid_bricks {
    int n[3]; /* bricks on each axis; the last ones may extend beyond the lattice */
    size_t count;
    uint32_t *number; /* [count] ascending */
    /* [bricks of the lattice]: its index in `number` plus 1; 0: not stored, outside; BRICK_INSIDE: not stored, inside. */
    uint32_t *slot;
};

struct frame_grid {
    const char *name; /* surface, density, stress, ... */
    const char *unit;
    enum grid_class kind;
    int components; /* 0 or 1: a scalar. 3: a vector in the simulator's axes, interleaved */
    float inside;   /* the value of inside samples that are not stored; unused in level sets */
    float *deep;    /* [bricks of the lattice]: the same per brick, or NULL; owned by the frame */
    /* [bricks.count * BRICK_SAMPLES * components], owned by the frame; NULL: not in memory, see struct grid_source */
    float *value;
};

/* Where the samples of grids are that are not in memory. */
struct grid_source {
    void *user;
    /* Makes the array of `value`, to be freed with free(). */
    status (*read)(void *user, const struct frame_grid *grid, float **out);
};

struct frame_grids {
    struct grid_lattice lattice;
    struct grid_bricks bricks;
    size_t n_grids;
    struct frame_grid grid[VALUES];
    struct grid_source source;
};
/* Active voxels in files: in level sets those with |value| < 3 voxels (the background); in other scalar grids those where `density` is not
 * 0; in vector grids those with a vector that is not zero. */

/* The numbers of bricks of a lattice on each axis; returns their product. */
size_t grid_bricks_of(const int n[3], int out[3]);

/* Grids on that lattice, still without bricks. Free with frame_grids_free(). E_MEMORY. */
MUST_USE status frame_grids_begin(const struct grid_lattice *lattice, struct frame_grids *out);

/* Sets the stored bricks: n numbers in ascending order. Takes ownership of *numbers. */
void frame_grids_choose(struct frame_grids *grids, uint32_t **numbers, size_t n);

/* Adds a grid for this value, not sampled yet; *out stays valid. E_OUTPUT: it exists already, or there are VALUES grids. */
MUST_USE status frame_grids_add(struct frame_grids *grids, enum value_id value, struct frame_grid **out);

/* Reads the samples of a grid if they are not in memory. */
MUST_USE status frame_grid_read(const struct frame_grids *grids, struct frame_grid *grid);

/* The grid of that name, or NULL. */
const struct frame_grid *frame_grid_named(const struct frame_grids *grids, const char *name);

/* Harmless on {0}. */
void frame_grids_free(struct frame_grids *grids);

/* The value of samples outside of all bricks. */
static inline float grid_background(const struct frame_grids *grids, const struct frame_grid *grid)
{
    return grid->kind == GRID_LEVEL_SET ? (float)(GRID_BAND * grids->lattice.voxel) : 0;
}

/* The number of the brick that contains a sample. */
static inline size_t grid_brick(const struct frame_grids *grids, int i, int j, int k)
{
    const int *n = grids->bricks.n;
    return ((size_t)(k / BRICK_SIDE) * (size_t)n[1] + (size_t)(j / BRICK_SIDE)) * (size_t)n[0] +
           (size_t)(i / BRICK_SIDE);
}

/* The value of all samples of this brick, which is BRICK_INSIDE. */
static inline float grid_inside(const struct frame_grids *grids, const struct frame_grid *grid, size_t brick)
{
    return grid->kind == GRID_LEVEL_SET ? -grid_background(grids, grid)
           : grid->deep                 ? grid->deep[brick]
                                        : grid->inside;
}

enum { ROW_OUTSIDE = -1, ROW_INSIDE = -2 };

/* The index in an array of sample (i, j, k) and the following ones along x, to the end of their brick; ROW_OUTSIDE or ROW_INSIDE if they
 * are not stored. */
static inline ptrdiff_t grid_row(const struct frame_grids *grids, int i, int j, int k)
{
    const struct grid_bricks *b = &grids->bricks;
    const size_t at = grid_brick(grids, i, j, k);
    if (b->slot[at] == 0 || b->slot[at] == BRICK_INSIDE)
        return b->slot[at] == 0 ? ROW_OUTSIDE : ROW_INSIDE;
    return (ptrdiff_t)(b->slot[at] - 1) * BRICK_SAMPLES +
           ((k % BRICK_SIDE) * BRICK_SIDE + j % BRICK_SIDE) * BRICK_SIDE + i % BRICK_SIDE;
}

/* A sample of a scalar grid. */
static inline float grid_at(const struct frame_grids *grids, const struct frame_grid *grid, int i, int j,
                            int k)
{
    const ptrdiff_t at = grid_row(grids, i, j, k);
    return at >= 0             ? grid->value[at]
           : at == ROW_OUTSIDE ? grid_background(grids, grid)
                               : grid_inside(grids, grid, grid_brick(grids, i, j, k));
}

#endif
