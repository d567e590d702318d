/* The wind as files, pictures and checkpoints have it. In frames it is a grid `wind`, in m/s, on the air's lattice. */
#ifndef HOODOO_AIR_H
#define HOODOO_AIR_H

#include "checkpoint/checkpoint.h"
#include "field/aov.h"
#include "wind/wind.h"

/* The averaged flow as the frame's air; nothing where the wind is the same everywhere. Waits. */
MUST_USE status air_grid(struct gpu *gpu, const struct wind *w, const struct job *job, int frame,
                         struct frame_grids *out);

/* The wind on the device, for pictures: that of `air`, or, where it has no grid, the job's in that frame. out->velocity is the
 * caller's to destroy. */
MUST_USE status air_upload(struct gpu *gpu, const struct frame_grids *air, const struct job *job, int frame,
                           struct aov_air *out);

/* The flow's state, as sections of a checkpoint. A branch whose air is of another size than the checkpoint's, or
 * that had none yet, begins with still air. Wait. */
MUST_USE status air_save(struct gpu *gpu, struct wind *wind, struct checkpoint *out);
MUST_USE status air_restore(struct gpu *gpu, struct wind *wind, const struct checkpoint *from);

#endif
