/* Removal of unsupported voxels.
 *
 * As in blocks.h, connectivity is that of the visible surface: blocks are connected through voxels of which at least half is left.
 * More weathered rock stays if a face neighbour does. The caller labels the blocks in between, since this folder and src/blocks do
 * not depend on each other:
 *
 *   voxels_solid -> blocks_join -> voxels_fall -> voxels_remove
 */
#ifndef HOODOO_SUPPORT_H
#define HOODOO_SUPPORT_H

#include "voxels/voxels.h"

/* Sets solid[(z ny + y) nx + x] to 1 for voxels that can support others, else to 0. Records only. */
void voxels_solid(struct gpu *gpu, const struct voxels *v, struct gpu_buffer *solid);

/* Marks unsupported voxels as gone, by `solid` and each block's lowest voxel `root`. `stands` is scratch. All three: uint [voxels of
 * the domain]. Waits for the device. */
MUST_USE status voxels_fall(struct gpu *gpu, struct gpu_work *work, struct voxels *v,
                            struct gpu_buffer *solid, struct gpu_buffer *root, struct gpu_buffer *stands);

#endif
