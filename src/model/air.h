/* The wind in files, pictures and checkpoints. In frames it is a grid `wind`, in m/s, on the lattice of the air. */
#ifndef HOODOO_AIR_H
#define HOODOO_AIR_H

#include "checkpoint/checkpoint.h"
#include "field/aov.h"
#include "wind/wind.h"

/* Makes the frame's air from the averaged flow; nothing if the wind is uniform. Waits. */
MUST_USE status air_grid(struct gpu *gpu, const struct wind *w, const struct job *job, int frame,
                         struct frame_grids *out);

/* Uploads the wind for pictures: the grid of `air` or, if it has none, the job's uniform wind in that frame. The caller destroys
 * out->velocity. */
MUST_USE status air_upload(struct gpu *gpu, const struct frame_grids *air, const struct job *job, int frame,
                           struct aov_air *out);

/* Save and restore the state of the flow as sections of a checkpoint. A branch starts with still air if the checkpoint has none or air
 * of another size. Wait. */
MUST_USE status air_save(struct gpu *gpu, struct wind *wind, struct checkpoint *out);
MUST_USE status air_restore(struct gpu *gpu, struct wind *wind, const struct checkpoint *from);

#endif
