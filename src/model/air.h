/* The wind as volumes, pictures and checkpoints have it. In frames it is a grid `vel` in m/s on a lattice of its own. */
#ifndef HOODOO_AIR_H
#define HOODOO_AIR_H

#include "checkpoint/checkpoint.h"
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

/* The flow's state, as sections of a checkpoint. A branch whose air is of another size than the checkpoint's, or
 * that had none yet, begins with still air. Wait. */
MUST_USE status air_save(struct gpu *gpu, struct wind *wind, struct checkpoint *out);
MUST_USE status air_restore(struct gpu *gpu, struct wind *wind, const struct checkpoint *from);

#endif
