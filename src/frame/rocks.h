/* The rocks that frames show as instances: piles of them in rock layers (arches), or on deposits (arenite).
 *
 * A tile of rocks repeats through space, and layers only select among the places of the tile. So a rock stays where it is as long as
 * the layer around it does, and has the same id whenever it appears.
 */
#ifndef HOODOO_ROCKS_H
#define HOODOO_ROCKS_H

#include "job/job.h"
#include "particles/frame.h"
#include "piles/piles.h"
#include "stacks/stacks.h"

/* The tile of the job's piles (job_piles()); out->n is 0 if the job has none. Free with pile_tile_destroy(). E_USAGE: the rocks are too
 * small for the domain. */
MUST_USE status rocks_tile(const struct job *job, struct pile_tile *out);

/* The layer (job/palette.h) whose colour the rocks have: rock's own in arches, else the top stratum, from which they fell. */
uint32_t rocks_layer(const struct job *job);

/* The rocks in the rock layers of the stacks. Does nothing if the tile is empty. */
MUST_USE status rocks_on_stacks(const struct job *job, const struct stacks *s, const struct pile_tile *tile,
                                struct frame_rocks *out);

/* The rocks in deposits of particles. A layer is a vertical run of voxels in whose neighbourhood at least half of what is not rock is
 * deposit; the average keeps rocks from appearing and vanishing with single grains. */
MUST_USE status rocks_on_deposits(const struct job *job, const struct rock *rock,
                                  const struct pile_tile *tile, struct frame_rocks *out);

#endif
