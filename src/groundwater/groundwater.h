/* Groundwater: rain infiltrates, flows along beds of low conductivity and seeps out of faces above them, which it erodes (sapping).
 * README.md has the laws.
 *
 * The flow is steady and computed from the current shape; there is no state, since water tables adapt within years.
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

/* Whether the job has recharge (groundwater.recharge_m_per_yr). */
bool groundwater_wanted(const struct job *job);

uint64_t groundwater_bytes(const struct job *job, const int voxels[3]);
MUST_USE status groundwater_create(struct gpu *gpu, const struct job *job, const int voxels[3],
                                   struct groundwater *out);
void groundwater_destroy(struct gpu *gpu, struct groundwater *g);

/* Computes the particles' field `seepage`, m/yr, for the current shape, and the erodibility of wet rock, which is weaker: it interlocks
 * only under more stress. Call after erosion_interlock(). Needs surface, stress and `layers` (struct erosion's). Waits for the device. */
MUST_USE status groundwater_find(struct gpu *gpu, struct groundwater *g, const struct job *job, int frame,
                                 struct gpu_buffer *layers, struct particles *p);

/* Adds sapping to intensity and its share to `parts`, as water_erode() does. Records only. */
void groundwater_sap(struct gpu *gpu, const struct groundwater *g, const struct job *job,
                     const struct particles *p, struct gpu_buffer *intensity, struct gpu_buffer *parts);

#endif
