/* Voxels that nothing holds.
 *
 * As in blocks.h, rock holds where it can be seen: blocks are joined through voxels of which at least half is
 * left. More weathered rock clings to what stands beside it. The caller joins the blocks in between, since
 * voxels and blocks do not know each other:
 *
 *   voxels_solid -> blocks_join -> voxels_fall -> voxels_remove
 */
#ifndef HOODOO_SUPPORT_H
#define HOODOO_SUPPORT_H

#include "voxels/voxels.h"

/* Which voxels of the domain, (z ny + y) nx + x, hold others. Records only. */
void voxels_solid(struct gpu *gpu, const struct voxels *v, struct gpu_buffer *solid);

/* Marks as gone what does not stand, going by `solid` and each block's lowest voxel `root`. `stands` is
 * scratch, an item a voxel of the domain. Waits. */
MUST_USE status voxels_fall(struct gpu *gpu, struct gpu_work *work, struct voxels *v,
                            struct gpu_buffer *solid, struct gpu_buffer *root, struct gpu_buffer *stands);

#endif
