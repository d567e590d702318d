/* Loose material slides until nothing is steeper than its angle of repose (Arches 3.4). README.md has the equations.
 *
 * Materials move one after the other, lower ones first, from each space to the spaces of the eight neighbouring stacks: over edges,
 * through holes, under lintels, down to whatever floor is there. The materials above ride along. Each move levels a space with its lower
 * neighbours, up to the stable rise between them, so that it never overshoots: the potential energy of the moving material decreases
 * with every move, which is why the algorithm terminates.
 */
#ifndef HOODOO_STABILISE_H
#define HOODOO_STABILISE_H

#include <stdbool.h>

#include "stacks/spaces.h"

struct stabilise {
    const struct material *table;
    int n_materials;
    unsigned walls; /* WALL_* of shared/params.h; material leaves the grid across all other sides */
    int64_t sweeps; /* limit of sweeps per material; 0: until all is at rest */
};

struct stabilised {
    bool resting;                 /* nothing can move any more */
    int64_t sweeps, moves;        /* numbers of */
    uint64_t left[MATERIALS_MAX]; /* quanta that left across the sides */
    uint64_t lost;                /* quanta of water displaced below ceilings */
};

/* Material moves where it is steeper than its angle of repose plus this. */
#define STABILISE_TOLERANCE_DEG 0.25

/* Stabilises the stacks lo..hi and wherever material slides from there; all others must be at rest already. Also merges and sorts the loose
 * layers there. The same stacks give the same bits. On an error s is unchanged. E_MEMORY. */
MUST_USE status stabilise(struct stacks *s, const struct stabilise *options, const int lo[2], const int hi[2],
                          struct stabilised *out);

#endif
