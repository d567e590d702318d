/* What a frame's volumes show deep inside the rock, where no particles need be: nothing is gone of it, and its stress is the stress
 * grid's own, at the samples of `stress` and `von_mises`, and one value for each brick that is not kept. */
#ifndef HOODOO_INSIDE_H
#define HOODOO_INSIDE_H

#include "particles/grids.h"
#include "stress/places.h"

/* The stress must be current. Harmless where the grids are not there, or no stress was found. Waits. */
MUST_USE status inside_values(struct gpu *gpu, struct elastic *e, struct frame_grids *grids);

#endif
