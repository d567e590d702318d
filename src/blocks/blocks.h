/* Unsupported blocks: parts of the rock that no path across voxel faces joins to the ground.
 *
 * Connectivity is that of the visible surface: a path goes through voxels whose centre is inside the surface field. A particle is
 * supported if its voxel, or one across a face, is on such a path; so threads and grains below the resolution fall. Deposits stay
 * as long as the rock below them does. Joints separate the voxels on either side. README.md has the algorithm.
 */
#ifndef HOODOO_BLOCKS_H
#define HOODOO_BLOCKS_H

#include "gpu/gpu.h"
#include "gpu/primitives.h"
#include "particles/deep.h"

struct blocks {
    struct gpu_buffer *solid; /* uint [held voxels]: 1 inside the surface */
    /* uint [held voxels, then runs of deep voxels along x]: slot of the block's lowest voxel */
    struct gpu_buffer *pointer, *other;
    struct gpu_buffer
        *first; /* uint [held_words() + 1]: runs before each word of bits; NULL until there are any */
    struct gpu_buffer *parted; /* joints between voxels (geology/maps.h), not owned; NULL: none */
    bool rubble;               /* there may be rubble, which rests on rock across small gaps */
};

/* Bytes on the device for n held voxels. */
uint64_t blocks_bytes(size_t n);

/* Creates buffers for n held voxels; they grow when needed. With joints (`parted` not NULL) no voxel may be deep. */
MUST_USE status blocks_create(struct gpu *gpu, size_t n, struct gpu_buffer *parted, struct blocks *out);
void blocks_destroy(struct gpu *gpu, struct blocks *b);

/* Labels the blocks of `solid`, which the caller has filled: pointer[i] of a solid voxel becomes its block's lowest voxel, which is
 * in the first slab if the block stands on the ground. Waits for the device. */
MUST_USE status blocks_join(struct gpu *gpu, struct gpu_work *work, struct blocks *b,
                            const struct held_voxels *held);

/* Labels the blocks of the current rock. *n_cut: number of deep voxels in blocks that do not stand on the ground; if it is not 0
 * the caller must create their particles (bits in p->flags) and call again. Waits for the device. */
MUST_USE status blocks_find(struct gpu *gpu, struct gpu_work *work, struct blocks *b, struct particles *p,
                            size_t *n_cut);

/* After blocks_find(): lists the unsupported particles of blocks of at least `least` particles in p->surface, ascending; *n is
 * their number. Sets the viability of those of smaller blocks to 0 and counts them in *n_fragments; they are not removed yet.
 * Particles whose viability is used up are neither. The surface must be computed again afterwards. Waits for the device. */
MUST_USE status blocks_loose(struct gpu *gpu, struct gpu_work *work, struct blocks *b, struct particles *p,
                             size_t least, uint32_t *n_fragments, size_t *n);

/* After blocks_find(): sets the viability of all unsupported particles to 0 and counts them; they are not removed yet. Waits for
 * the device. */
MUST_USE status blocks_fall(struct gpu *gpu, struct gpu_work *work, struct blocks *b, struct particles *p,
                            uint32_t *n_fallen);

#endif
