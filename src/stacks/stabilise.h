/* Loose material slides until nothing is steeper than its angle of repose (Arches 3.4).
 *
 * Materials move one after the other, those below first, from each space to the spaces of the eight stacks
 * around it: over edges, through holes, under lintels, down to whatever floor is there. What lies on them
 * rides along. Each move levels one space with those below it as far as they may be level, so that it never
 * overshoots: the moving material's potential energy only falls, which is why this ends.
 */
#ifndef HOODOO_STABILISE_H
#define HOODOO_STABILISE_H

#include <stdbool.h>

#include "stacks/spaces.h"

struct stabilise {
    const struct material *table;
    int n_materials;
    unsigned walls; /* WALL_* of shared/params.h: what reaches another side of the grid leaves */
    int64_t sweeps; /* at most so many over what moves of each material; 0: until it rests */
};

struct stabilised {
    bool resting;                 /* nothing is left to move */
    int64_t sweeps, moves;        /* made */
    uint64_t left[MATERIALS_MAX]; /* quanta over the sides */
    uint64_t lost;                /* quanta of water squeezed out under ceilings */
};

/* Steeper than repose by this much, and material moves. */
#define STABILISE_TOLERANCE_DEG 0.25

/* Stabilises what is in, or slides out of, the stacks lo..hi; the rest is taken to rest already. Also merges
 * and sorts the layers there. Equal stacks give equal bits. On an error nothing has changed. */
MUST_USE status stabilise(struct stacks *s, const struct stabilise *options, const int lo[2], const int hi[2],
                          struct stabilised *out);

#endif
