/* The wind of a frame as files and pictures have it: a grid `vel` in m/s on a lattice of its own. */
#ifndef HOODOO_AIR_H
#define HOODOO_AIR_H

#include "field/aov.h"
#include "wind/wind.h"

/* The averaged flow added to the frame's grids. A wind that is the same everywhere is no grid: its few samples
 * would only widen the box of the volume that a program sees. Waits. */
MUST_USE status air_add(struct gpu *gpu, const struct wind *w, const struct job *job, int frame,
                        struct frame_grids *grids);

/* The wind on the device, for pictures: the grid `vel` among these, or else the job's in that frame.
 * out->velocity is the caller's to destroy. */
MUST_USE status air_upload(struct gpu *gpu, const struct frame_grids *grids, const struct job *job, int frame,
                           struct aov_air *out);

#endif
