/* The wind of a frame as files and pictures have it: a grid `vel` in m/s on a lattice of its own. */
#ifndef HOODOO_AIR_H
#define HOODOO_AIR_H

#include "field/aov.h"
#include "wind/wind.h"

/* The averaged flow, or, where there is none, the same wind all over the domain. *out is the caller's to free
 * (value). Waits. */
MUST_USE status air_grid(struct gpu *gpu, const struct wind *w, const struct job *job, int frame,
                         const int voxels[3], struct frame_grid *out);

/* The grid `vel` among these on the device, for pictures; without one there is no air (velocity NULL). */
MUST_USE status air_upload(struct gpu *gpu, const struct frame_grids *grids, struct aov_air *out);

#endif
