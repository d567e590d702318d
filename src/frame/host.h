/* What frames take in host memory: one is written while the next one is made. */
#ifndef HOODOO_FRAME_HOST_H
#define HOODOO_FRAME_HOST_H

#include "frame/disk.h"

/* A rock of n particles, with every field but their velocities: 16 more where it moves. */
uint64_t host_rock_bytes(size_t n);

/* Samples of a grid of a frame whose domain has these voxels: those of the bricks (particles/grids.h) that rock of so many
 * voxels is in, so many of them at its surface. */
uint64_t host_grid_samples(const int voxels[3], uint64_t rock, uint64_t bare);

/* One frame of the job, each of its grids having so many samples; `own` is what only its model's frames have. */
uint64_t host_frame_bytes(const struct job *job, const struct scene_size *size, uint64_t samples,
                          uint64_t own);

/* All that its frames take at most: one that is written, and one that is made. Within a tenth of what was measured. */
uint64_t host_frames_bytes(const struct job *job, const struct scene_size *size, uint64_t samples,
                           uint64_t own, const struct disk_frame *files);

#endif
