/* The structure by voxel, for kernels. Computed once from the job; not part of any state. */
#ifndef HOODOO_MAPS_H
#define HOODOO_MAPS_H

#include "base/status.h"
#include "gpu/gpu.h"
#include "job/job.h"

struct maps {
    /* uint, four voxels per word, by (k ny + j) nx + i: the ratio of a front's speed along the beds to that across, as MAPS_OCTAVE times its
     * log2. NULL: there are no generated beds, and it is 1. */
    struct gpu_buffer *along;
    /* uint, two for each word of a voxel set (particles/held.h): is a voxel separated by a joint from its lower neighbour in x, and in y?
     * NULL: none is. */
    struct gpu_buffer *parted;
    /* float, by cell of the stress grid (two voxels wide), (k ny / 2 + j) nx / 2 + i: the factor of joints on its stiffness. NULL: 1. */
    struct gpu_buffer *stiff;
};

/* Device memory, bytes. */
uint64_t maps_bytes(const struct job *job, const int voxels[3]);

/* Errors of structure_create(). */
MUST_USE status maps_create(struct gpu *gpu, const struct job *job, const int voxels[3], struct maps *out);
void maps_destroy(struct gpu *gpu, struct maps *m);

#endif
