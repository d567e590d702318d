/* Rock as voxels, weathering as bubbles: Goblins by Spheroidal Weathering (Beardall et al. 2007).
 *
 * Which voxels are rock is a bit each. The active ones, a skin with air within a few voxels, lose what is
 * left of them by their layer's rate, their own factor, and the air in their bubble; both bit sets and the
 * counts of air are kept up by what vanishes in each cycle, near where it vanished.
 *
 * One cycle (two steps, synchronous: nobody sees a voxel go before all have been asked):
 *
 *   pace -> decimate -> apply -> touch -> skin -> list -> count
 *
 * Layout    a voxel's number is its bit's in the sets: words of 32 along x, one word of air between rows,
 *           `margin` rows and slabs around the domain for bubbles to reach into. Slabs below the domain are
 *           rock, unless the rock floats; behind walls lies the mirror image of the domain.
 * Same bits integers are counted, every voxel sums for itself.
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
    size_t n_active, n_cycles; /* n_cycles: since it was made */
    int skin;                  /* voxels */
    struct gpu_buffer *bits;   /* uint [2][words]: gone in this cycle; rock */
    struct gpu_buffer *skin_bits, *touched, *gone_bricks, *place;
    struct gpu_buffer *left;  /* float [voxels]: of each, 1 to 0 */
    struct gpu_buffer *state; /* uint [voxels]: air in the bubble; factor of the rate, as a half */
    struct gpu_buffer *list;  /* uint [n_active]: the active voxels, ascending; grows */
    struct gpu_buffer *rows, *bubbles, *layer_of, *layers, *paces;
    struct bubble_rate *rate; /* by layer */
};

/* Bytes on the device with so many active voxels; with *words, what gpu_work_create() must be good for. */
uint64_t voxels_bytes(const struct job *job, const int n[3], size_t n_active, size_t *words);

/* `share` and `factor` have a value for each voxel of the domain, (z ny + y) nx + x: what is left of it, 0
 * for air, and what its layer's rate is multiplied with. Waits. E_USAGE: a bubble does not fit the voxels. */
MUST_USE status voxels_create(struct gpu *gpu, struct gpu_work *work, const struct job *job, const int n[3],
                              const float *share, const float *factor, struct voxels *out);
void voxels_destroy(struct gpu *gpu, struct voxels *v);

/* The layers' rates as they are in this frame. */
MUST_USE status voxels_rates(struct gpu *gpu, struct voxels *v, const struct job *job, int frame);

/* One cycle of at most `kyr` and at least the quantum; *passed is what it took, *n_gone how many voxels
 * vanished. Waits. */
MUST_USE status voxels_cycle(struct gpu *gpu, struct gpu_work *work, struct voxels *v, double quantum,
                             double kyr, double *passed, uint32_t *n_gone);

/* Takes out the voxels whose bits are set in the first half of `bits`, and brings skin, list and air up to
 * date: for what does not vanish by itself. *n_gone: how many they were. Waits. */
MUST_USE status voxels_remove(struct gpu *gpu, struct gpu_work *work, struct voxels *v, uint32_t *n_gone);

/* What is left of each voxel of the domain and its factor, as voxels_create() takes them; either may be NULL.
 * Waits. */
MUST_USE status voxels_download(struct gpu *gpu, const struct voxels *v, float *share, float *factor);

/* A voxel of the domain's number in the buffers. */
size_t voxels_number(const struct voxels *v, int x, int y, int z);

/* The parameters of a kernel over n items. */
struct voxels_params voxels_params(const struct voxels *v, size_t n);

#endif
