/* Values of a frame's volumes deep inside the rock, where there may be no particles. Viability is 1 there. Stress and von Mises stress come
 * from the stress grid, at the samples of kept bricks, and one value for each brick that is not kept; their samples are in memory
 * afterwards. */
#ifndef HOODOO_INSIDE_H
#define HOODOO_INSIDE_H

#include "particles/grids.h"
#include "stress/places.h"

/* The stress must be current. Does nothing if the frame does not have these grids or no stress was computed. Waits. */
MUST_USE status inside_values(struct gpu *gpu, struct elastic *e, struct frame_grids *grids);

#endif
