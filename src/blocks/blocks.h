/* Blocks that nothing holds: parts of the rock with no face path to the ground. */
#ifndef HOODOO_BLOCKS_H
#define HOODOO_BLOCKS_H

#include "gpu/gpu.h"
#include "gpu/primitives.h"
#include "particles/particles.h"

struct blocks {
    struct gpu_buffer *pointer, *other; /* uint [voxels] */
};

uint64_t blocks_bytes(const int voxels[3]);
MUST_USE status blocks_create(struct gpu *gpu, const int voxels[3], struct blocks *out);
void blocks_destroy(struct gpu *gpu, struct blocks *b);

/* Takes the viability of unsupported particles and counts them; they are not yet removed. Waits. */
MUST_USE status blocks_fall(struct gpu *gpu, struct gpu_work *work, struct blocks *b, struct particles *p,
                            uint32_t *n_fallen);

#endif
