/* What the files of mpm/ share. */
#ifndef HOODOO_MPM_INTERNAL_H
#define HOODOO_MPM_INTERNAL_H

#include "mpm/mpm.h"

enum { SCALARS = 8 };

/* Bit of the number of a joint that has parted two pieces. */
static const uint32_t MPM_PARTED = 0x80000000u;

struct mpm_params mpm_params_of(const struct mpm *m, size_t n, double dt);

/* m/s: the fastest wave. */
double mpm_wave(const struct mpm_options *o);

/* Pieces: their tables; and which of them are bodies, as joints stand. The latter waits. */
MUST_USE status mpm_pieces_create(struct gpu *gpu, struct mpm *m);
void mpm_pieces_destroy(struct gpu *gpu, struct mpm *m);
uint64_t mpm_pieces_bytes(const int voxels[3], double h, double block);
MUST_USE status mpm_pieces_look(struct gpu *gpu, struct mpm *m);
struct mpm_load_params mpm_load_params_of(const struct mpm *m, size_t n);

/* Sorts the points and finds their parts and the nodes near them. Those that have left are dropped. Waits. */
MUST_USE status mpm_sort(struct gpu *gpu, struct gpu_work *work, struct mpm *m);

/* One step of rock in motion, sorted: particles to grid, grid, grid to particles. `last`: leaves no impulse of
 * stress. Records only. */
void mpm_step(struct gpu *gpu, struct mpm *m, const struct mpm_params *params, bool last);

#endif
