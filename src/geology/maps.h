/* What of the structure kernels ask about by voxel: made once from the job, and not part of any state. */
#ifndef HOODOO_MAPS_H
#define HOODOO_MAPS_H

#include "base/status.h"
#include "gpu/gpu.h"
#include "job/job.h"

struct maps {
    /* uint, four voxels of the domain to a word, by (k ny + j) nx + i: how many times faster than across the beds a front runs along
     * them, as MAPS_OCTAVE log2 of it. NULL: no beds are made, and it is 1 everywhere. */
    struct gpu_buffer *along;
    /* uint, two for each word of voxels as bits (particles/held.h): whether a joint parts a voxel from the one before it in x, and in y.
     * NULL: none does. */
    struct gpu_buffer *parted;
    /* float, of each cell of the stress grid, two voxels wide, by (k ny / 2 + j) nx / 2 + i: its share of the stiffness that it would have
     * without joints. NULL: 1 everywhere. */
    struct gpu_buffer *stiff;
};

/* Bytes on the device. */
uint64_t maps_bytes(const struct job *job, const int voxels[3]);

/* E_USAGE as structure_create()'s. */
MUST_USE status maps_create(struct gpu *gpu, const struct job *job, const int voxels[3], struct maps *out);
void maps_destroy(struct gpu *gpu, struct maps *m);

#endif
