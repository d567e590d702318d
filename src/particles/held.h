/* Sparse storage of voxels: only held voxels have items in buffers, so that memory grows with the rock and not with its bounding box.
 *
 * Bits per voxel say whether it is occupied, held or deep. Held voxels are numbered in voxel order; their numbers, the slots, are indices
 * into buffers. shaders/particles/bits.glsl and held.glsl are the kernels' side and describe the words.
 */
#ifndef HOODOO_HELD_H
#define HOODOO_HELD_H

#include "gpu/gpu.h"
#include "gpu/primitives.h"

struct held_voxels {
    int voxels[3];
    size_t n, room; /* held voxels; capacity of the list */
    /* uint [HELD_STRIDE (words + 1)]: bits of held voxels, the number of held voxels before them, and bits of occupied voxels */
    struct gpu_buffer *words;
    struct gpu_buffer *list; /* uint [room]: of each held voxel 32 times its word plus its bit */
};

static inline size_t voxel_count(const int voxels[3])
{
    return (size_t)voxels[0] * (size_t)voxels[1] * (size_t)voxels[2];
}

/* The number of 32-bit words of a bit set of voxels: each row starts with a new word. */
static inline size_t held_words(const int voxels[3])
{
    return ((size_t)voxels[0] + 31) / 32 * (size_t)voxels[1] * (size_t)voxels[2];
}

/* Device memory for n held voxels, bytes. */
uint64_t held_bytes(const int voxels[3], size_t n);

/* No voxel is occupied or held yet; capacity for n. E_MEMORY. */
MUST_USE status held_create(struct gpu *gpu, const int voxels[3], size_t n, struct held_voxels *out);
void held_destroy(struct gpu *gpu, struct held_voxels *h);

/* Clears all bits except that deep voxels remain occupied; the caller then marks the other occupied voxels. Records only. */
void held_vacate(struct gpu *gpu, struct held_voxels *h);

/* Sets the occupied voxels to `bits` (host); none is held or deep. Waits for the device. */
MUST_USE status held_occupy(struct gpu *gpu, struct held_voxels *h, const uint32_t *bits);

/* Call after either of them. Determines the held voxels: all occupied ones that are not deep and, if `around`, those that share a face, an
 * edge or a corner with one. Waits for the device. */
MUST_USE status held_find(struct gpu *gpu, struct gpu_work *work, struct held_voxels *h, bool around);

/* Makes all voxels occupied and held, for dense use. Waits for the device. */
MUST_USE status held_all(struct gpu *gpu, struct gpu_work *work, struct held_voxels *h);

#endif
