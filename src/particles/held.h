/* Which of a domain's voxels anything is kept of: the held ones, so that memory grows with the rock and not with its box.
 *
 * A bit for each voxel says whether it is occupied, others whether it is held or deep; held voxels are numbered in the order of
 * all voxels, and their numbers, the slots, are places in buffers of voxels. The kernels' side is shaders/particles/bits.glsl and
 * held.glsl, which tell what the words mean.
 */
#ifndef HOODOO_HELD_H
#define HOODOO_HELD_H

#include "gpu/gpu.h"
#include "gpu/primitives.h"

struct held_voxels {
    int voxels[3];
    size_t n, room; /* held voxels; numbers there is room for in the list */
    /* uint [HELD_STRIDE (words + 1)]: bits of held voxels, how many are held before them, and bits of occupied ones */
    struct gpu_buffer *words;
    struct gpu_buffer *list; /* uint [room]: 32 times its word and its bit, of each held voxel */
};

static inline size_t voxel_count(const int voxels[3])
{
    return (size_t)voxels[0] * (size_t)voxels[1] * (size_t)voxels[2];
}

/* Words of bits: those of a row are its own. */
static inline size_t held_words(const int voxels[3])
{
    return ((size_t)voxels[0] + 31) / 32 * (size_t)voxels[1] * (size_t)voxels[2];
}

/* Bytes on the device where n voxels are held. */
uint64_t held_bytes(const int voxels[3], size_t n);

/* No voxel is occupied or held; there is room for n. */
MUST_USE status held_create(struct gpu *gpu, const int voxels[3], size_t n, struct held_voxels *out);
void held_destroy(struct gpu *gpu, struct held_voxels *h);

/* Only deep voxels are still occupied, and none is held: then the caller occupies what else is. Records only. */
void held_vacate(struct gpu *gpu, struct held_voxels *h);

/* These voxels are occupied, and no others; none is held or deep. `bits` are the host's. Waits. */
MUST_USE status held_occupy(struct gpu *gpu, struct held_voxels *h, const uint32_t *bits);

/* After either of them: finds what is held, which is the occupied voxels; if `around`, also those that touch one by a face, an edge
 * or a corner; but no deep one. Waits. */
MUST_USE status held_find(struct gpu *gpu, struct gpu_work *work, struct held_voxels *h, bool around);

/* All voxels are occupied and held, for users that have a place for each. Waits. */
MUST_USE status held_all(struct gpu *gpu, struct gpu_work *work, struct held_voxels *h);

#endif
