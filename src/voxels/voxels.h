/* Rock as voxels, weathered by the air in their bubbles: Goblins by Spheroidal Weathering (Beardall et al. 2007). README.md has the
 * equations.
 *
 * A bit per voxel says whether it is rock. The active voxels, a skin with air within a few voxels, weather by their layer's rate,
 * their own factor, and the air in their bubble. Bit sets and air counts are updated incrementally, only near voxels that vanished.
 *
 * One cycle, synchronous in two steps (no voxel vanishes before all have been updated):
 *
 *   pace -> decimate -> apply -> touch -> skin -> list -> count
 *
 * Layout       A voxel's number is that of its bit: words of 32 along x, one word of margin between rows, `margin` rows and slabs
 *              around the domain for bubbles to reach into. Slabs below the domain are rock, unless the rock floats; beyond walls
 *              lies the mirror image of the domain.
 * Determinism  Counts are integers, and every voxel sums for itself.
 */
#ifndef HOODOO_VOXELS_H
#define HOODOO_VOXELS_H

#include "gpu/gpu.h"
#include "gpu/primitives.h"
#include "job/job.h"
#include "voxels/bubble.h"

struct voxels {
    int n[3];                  /* voxels of the domain */
    double h;                  /* m */
    struct voxels_params grid; /* all but n and dt */
    size_t n_active, n_cycles; /* n_cycles: since voxels_create() */
    int skin;                  /* voxels */
    struct gpu_buffer *bits;   /* uint [2][words]: gone in this cycle; rock */
    struct gpu_buffer *skin_bits, *touched, *gone_bricks, *place;
    struct gpu_buffer *left; /* float [voxels]: share that is left, 1 to 0 */
    struct gpu_buffer *
        state; /* uint [voxels]: air in the bubble (low 16 bits); factor of the rate, half precision (high) */
    struct gpu_buffer *list; /* uint [n_active]: the active voxels, ascending; grows */
    struct gpu_buffer *rows, *bubbles, *layer_of, *layers, *paces;
    struct bubble_rate *rate; /* by layer */
};

/* Bytes on the device with n_active active voxels. *words: number of items that gpu_work_create() must support. */
uint64_t voxels_bytes(const struct job *job, const int n[3], size_t n_active, size_t *words);

/* E_USAGE: a bubble of the job does not fit its voxels. */
MUST_USE status voxels_check(const struct job *job);

/* `share` and `factor`, float [voxels of the domain] at (z ny + y) nx + x: share left (0: air), and factor of the layer's rate. Waits
 * for the device. E_USAGE: a bubble does not fit the voxels, or there are too many voxels. */
MUST_USE status voxels_create(struct gpu *gpu, struct gpu_work *work, const struct job *job, const int n[3],
                              const float *share, const float *factor, struct voxels *out);
void voxels_destroy(struct gpu *gpu, struct voxels *v);

/* Sets the layers' rates for a frame. Call before its cycles. */
MUST_USE status voxels_rates(struct gpu *gpu, struct voxels *v, const struct job *job, int frame);

/* One cycle: until the next voxel vanishes, but at least `quantum` of the fastest voxel's life and at most `kyr`. Voxels vanish in the
 * cycle whose end is nearest to their own, so that on average none lives longer for the quantum. *passed: the cycle's length, kyr;
 * *n_gone: voxels that vanished. Waits for the device. E_NUMERIC if rates are not finite. */
MUST_USE status voxels_cycle(struct gpu *gpu, struct gpu_work *work, struct voxels *v, double quantum,
                             double kyr, double *passed, uint32_t *n_gone);

/* Removes the voxels whose bits are set in the first half of `bits` (by voxels_fall(), for instance) and updates skin, list and air
 * counts. *n_gone: their number. Waits for the device. */
MUST_USE status voxels_remove(struct gpu *gpu, struct gpu_work *work, struct voxels *v, uint32_t *n_gone);

/* Downloads share and factor, laid out as for voxels_create(); either may be NULL. Waits for the device. */
MUST_USE status voxels_download(struct gpu *gpu, const struct voxels *v, float *share, float *factor);

/* Index in the buffers of a voxel of the domain. */
size_t voxels_number(const struct voxels *v, int x, int y, int z);

/* Parameters of a kernel over n items. */
struct voxels_params voxels_params(const struct voxels *v, size_t n);

#endif
