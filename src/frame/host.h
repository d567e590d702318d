/* Host memory that frames take. Two frames are in memory at a time, because one is written while the next one is made. */
#ifndef HOODOO_FRAME_HOST_H
#define HOODOO_FRAME_HOST_H

#include "frame/disk.h"

/* Bytes of a rock of n particles with all fields but velocities, which take 16 bytes more per particle where rock moves. */
uint64_t host_rock_bytes(size_t n);

/* Samples of one grid of a frame, in a domain of these voxels: those in the bricks (particles/grids.h) that contain rock, where `rock`
 * voxels are rock and `bare` of them are at its surface. */
uint64_t host_grid_samples(const int voxels[3], uint64_t rock, uint64_t bare);

/* Bytes of one frame of the job whose grids have `samples` samples each; `own` are the bytes that only frames of its model have. */
uint64_t host_frame_bytes(const struct job *job, const struct scene_size *size, uint64_t samples,
                          uint64_t own);

/* The most that frames take: one that is being written and one that is being made. Within a tenth of measurements. */
uint64_t host_frames_bytes(const struct job *job, const struct scene_size *size, uint64_t samples,
                           uint64_t own, const struct disk_frame *files);

#endif
