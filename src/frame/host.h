/* Host memory that frames take. */
#ifndef HOODOO_FRAME_HOST_H
#define HOODOO_FRAME_HOST_H

#include "frame/disk.h"

/* Bytes of a rock of n particles with all fields but velocities, which take 16 bytes more per particle where rock moves. */
uint64_t host_rock_bytes(size_t n);

/* Samples of one grid of a frame, in a domain of these voxels: those in the bricks (particles/grids.h) that contain rock, where `rock`
 * voxels are rock and `bare` of them are at its surface. */
uint64_t host_grid_samples(const int voxels[3], uint64_t rock, uint64_t bare);

/* How frames are made and written. Each pace takes less memory than the one before it, and more time. */
enum frame_pace {
    PACE_OVERLAP,   /* a frame is written while the next one is made, so two are in memory */
    PACE_ALTERNATE, /* each is written before the next one is made */
    PACE_STREAM, /* likewise, and the samples of volumes are read from the device grid by grid while they are written */
    PACES
};

/* The grids of a frame, and what else only frames of its model have. */
struct host_frame {
    uint64_t samples; /* of each grid */
    size_t grids;     /* floats per sample, of all grids */
    size_t kept;      /* floats per sample of grids that are in memory while others are streamed */
    uint64_t own;     /* bytes */
};

/* The most that frames take at a pace. Within a tenth of measurements. */
uint64_t host_frames_bytes(const struct job *job, const struct scene_size *size,
                           const struct host_frame *frame, const struct disk_frame *files,
                           enum frame_pace pace);

#endif
