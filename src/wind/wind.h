/* Wind on rock: deflation everywhere, abrasion where blown sand strikes (Arenite eqs. 7, 8, 12).
 *
 * Rates are intensities: 1 makes bare, unstressed rock retreat at its weak rate.
 */
#ifndef HOODOO_WIND_H
#define HOODOO_WIND_H

#include "gpu/gpu.h"
#include "job/job.h"
#include "particles/particles.h"

/* The wind far from the rock in a frame: unit direction and speed, m/s, gusts included. */
struct wind_at {
    double direction[3], speed;
};
struct wind_at wind_at(const struct job *job, int frame);

/* The intensity on a bare, unstressed face across the wind. */
double wind_intensity(const struct job *job, int frame);

/* intensity[i] = W of the surface's particle i (float [n_surface], in the order of p->surface). Needs surface
 * and stress of the current shape. Records only. */
void wind_erode(struct gpu *gpu, const struct job *job, int frame, struct particles *p,
                struct gpu_buffer *intensity);

#endif
