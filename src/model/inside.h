/* Stress deep inside the rock, where a frame's field shows none of it because no particles need be there: the stress grid's own, at the
 * samples of `stress` and `von_mises`, and one value for each brick that is not kept. */
#ifndef HOODOO_INSIDE_H
#define HOODOO_INSIDE_H

#include "particles/grids.h"
#include "stress/elastic.h"

/* The stress must be current. Harmless where the grids are not there, or no stress was found. Waits. */
MUST_USE status inside_stress(struct gpu *gpu, struct elastic *e, struct frame_grids *grids);

#endif
