/* Blocks that nothing holds: parts of the rock with no face path to the ground.
 *
 * Rock holds where it can be seen: a path goes through voxels whose middle lies inside the surface field.
 * Particles that no such voxel on the ground's side touches fall, threads and crumbs below the resolution
 * among them; but deposits stay while the rock they lie on does. Joints part rock from what is beside it.
 */
#ifndef HOODOO_BLOCKS_H
#define HOODOO_BLOCKS_H

#include "gpu/gpu.h"
#include "gpu/primitives.h"
#include "particles/deep.h"

struct blocks {
    struct gpu_buffer *solid; /* uint [held voxels]: 1 inside the surface */
    /* uint [held voxels, then runs along x of deep ones]: towards a block's lowest held voxel, as slots */
    struct gpu_buffer *pointer, *other;
    struct gpu_buffer
        *first; /* uint [held_words() + 1]: runs of deep voxels before; NULL while there never were any */
    struct gpu_buffer *parted; /* where joints part rock (geology/maps.h), the caller's; NULL: nowhere */
    bool rubble;               /* may there be any? It rests on what lies below, across small gaps */
};

/* Bytes on the device where n voxels are held. */
uint64_t blocks_bytes(size_t n);

/* Room for n held voxels; what is more gets room when it is looked at. Where joints part rock (`parted` is not NULL) no voxel is deep. */
MUST_USE status blocks_create(struct gpu *gpu, size_t n, struct gpu_buffer *parted, struct blocks *out);
void blocks_destroy(struct gpu *gpu, struct blocks *b);

/* From `solid`, which the caller filled, to `pointer`: each solid voxel's is its block's lowest voxel, which
 * is in the first slab if the block stands on the ground. Leaves gpu_work_words() zero. Waits. */
MUST_USE status blocks_join(struct gpu *gpu, struct gpu_work *work, struct blocks *b,
                            const struct held_voxels *held);

/* What stands on the ground, of the rock as it is. If *n_cut is not 0 there are deep voxels that do not: their particles are due,
 * their bits are in p->flags, and once they have come it is to be asked again. Waits. */
MUST_USE status blocks_find(struct gpu *gpu, struct gpu_work *work, struct blocks *b, struct particles *p,
                            size_t *n_cut);

/* Of what blocks_find() has found: lists unsupported particles in p->surface, ascending, of blocks that have `least`
 * particles or more; of smaller ones it takes the viability and counts the particles, which are not yet removed. What
 * erosion left nothing of is neither. The surface is to be found anew after this. Waits. */
MUST_USE status blocks_loose(struct gpu *gpu, struct gpu_work *work, struct blocks *b, struct particles *p,
                             size_t least, uint32_t *n_crumbs, size_t *n);

/* Likewise: takes the viability of unsupported particles and counts them; they are not yet removed. Waits. */
MUST_USE status blocks_fall(struct gpu *gpu, struct gpu_work *work, struct blocks *b, struct particles *p,
                            uint32_t *n_fallen);

#endif
