/* What goblins.c and goblins_resample.c share. */
#ifndef HOODOO_GOBLINS_H
#define HOODOO_GOBLINS_H

#include "model/resampling.h"

/* The sections of a checkpoint with so many voxels, borrowed from it: what is left of each, and its factor; checked against the
 * ledger. E_CHECKPOINT. */
MUST_USE status goblins_read(const struct checkpoint *c, const int voxels[3], const struct ledger *ledger,
                             const float **share, const float **factor);

/* See struct model_type. */
MUST_USE status goblins_resample(struct resampling *r);

#endif
