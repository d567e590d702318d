/* What the files of mpm/ share. */
#ifndef HOODOO_MPM_INTERNAL_H
#define HOODOO_MPM_INTERNAL_H

#include "mpm/mpm.h"

enum { SCALARS = 8 };

struct mpm_params mpm_params_of(const struct mpm *m, size_t n, double dt);

/* m/s: the fastest wave. */
double mpm_wave(const struct mpm_options *o);

/* Sorts the points and finds occupied cells and the nodes near them. Those that have left are dropped. Waits. */
MUST_USE status mpm_sort(struct gpu *gpu, struct gpu_work *work, struct mpm *m);

/* One step of rock in motion, sorted: particles to grid, grid, grid to particles. `last`: leaves no impulse of
 * stress. Records only. */
void mpm_step(struct gpu *gpu, struct mpm *m, const struct mpm_params *params, bool last);

#endif
