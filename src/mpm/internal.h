/* Internal interface of this folder. */
#ifndef HOODOO_MPM_INTERNAL_H
#define HOODOO_MPM_INTERNAL_H

#include "mpm/mpm.h"

enum { SCALARS = 8 };

/* Bit in MPM_JOINT: the joint has parted its two pieces. */
static const uint32_t MPM_PARTED = 0x80000000u;

struct mpm_params mpm_params_of(const struct mpm *m, size_t n, double dt);

/* Speed of pressure waves, m/s: sqrt((lambda + 2 mu) / density). */
double mpm_wave(const struct mpm_options *o);

/* Tables of pieces and joints. mpm_pieces_update() breaks joints of which enough particles have cracked, and finds the bodies; it
 * waits for the device. */
MUST_USE status mpm_pieces_create(struct gpu *gpu, struct mpm *m);
void mpm_pieces_destroy(struct gpu *gpu, struct mpm *m);
uint64_t mpm_pieces_bytes(const int voxels[3], double h, double block);
MUST_USE status mpm_pieces_update(struct gpu *gpu, struct mpm *m);
struct mpm_load_params mpm_load_params_of(const struct mpm *m, size_t n);

/* Sorts the points and finds parts, nodes and entries. Points that have left the domain are dropped. Waits for the device. */
MUST_USE status mpm_sort(struct gpu *gpu, struct gpu_work *work, struct mpm *m);

/* One time step of sorted points in motion: particles to grid, grid update, grid to particles. `last`: leaves the stress's impulse
 * out of the affine velocity, since the next frame's step may have another length. Records only. */
void mpm_step(struct gpu *gpu, struct mpm *m, const struct mpm_params *params, bool last);

#endif
