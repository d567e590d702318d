/* The rocks that frames show: piles of them over rock layers (arches), and lying on deposits (arenite).
 *
 * The tile of rocks repeats through space, and layers only choose among the places there are: so a rock stays
 * where it is as long as what it lies in stays, and has the same id whenever it is there.
 */
#ifndef HOODOO_ROCKS_H
#define HOODOO_ROCKS_H

#include "job/job.h"
#include "particles/frame.h"
#include "piles/piles.h"
#include "stacks/stacks.h"

/* The tile of the job's piles (job_piles()); n = 0 if it has none. E_USAGE: rocks too small for the domain. */
MUST_USE status rocks_tile(const struct job *job, struct pile_tile *out);

/* The layer (palette.h) whose colour they have: rock's, or that of the top stratum, which they fell from. */
uint32_t rocks_layer(const struct job *job);

/* The rocks where the stacks have rock layers. Nothing where the tile has none. */
MUST_USE status rocks_on_stacks(const struct job *job, const struct stacks *s, const struct pile_tile *tile,
                                struct frame_rocks *out);

/* The rocks where particles are deposits: a layer is voxels above each other around which half of what is not
 * rock is deposit, so that rocks do not come and go with grains. */
MUST_USE status rocks_on_deposits(const struct job *job, const struct rock *rock,
                                  const struct pile_tile *tile, struct frame_rocks *out);

#endif
