/* Groundwater: rain that sinks in, flows along beds that it does not pass, and seeps out above them, where it wears the face away (sapping).
 * README.md in this folder has the law.
 *
 * All of it follows from the shape as it is, and nothing is kept from step to step: water comes and goes within years.
 */
#ifndef HOODOO_GROUNDWATER_H
#define HOODOO_GROUNDWATER_H

#include "gpu/gpu.h"
#include "groundwater/columns.h"
#include "particles/particles.h"

struct groundwater {
    struct columns columns;
    struct gpu_buffer *rock; /* uint: columns.rock on the device */
    struct gpu_buffer *wet;  /* vec4 [n_beds][n_columns][2]: columns.wet */
};

/* Does the job have any? */
bool groundwater_wanted(const struct job *job);

uint64_t groundwater_bytes(const struct job *job, const int voxels[3]);
MUST_USE status groundwater_create(struct gpu *gpu, const struct job *job, const int voxels[3],
                                   struct groundwater *out);
void groundwater_destroy(struct gpu *gpu, struct groundwater *g);

/* Where it seeps out of the rock as it is: the particles' field `seepage`; and wet rock is more erodible than its stress lets it be. Needs surface,
 * stress and `layers` (struct erosion's). Waits. */
MUST_USE status groundwater_find(struct gpu *gpu, struct groundwater *g, const struct job *job, int frame,
                                 struct gpu_buffer *layers, struct particles *p);

/* Adds sapping to the intensity on the surface, and water's share in it to `parts`, as water_erode() does. Records only. */
void groundwater_sap(struct gpu *gpu, const struct groundwater *g, const struct job *job,
                     const struct particles *p, struct gpu_buffer *intensity, struct gpu_buffer *parts);

#endif
