/* Transfers values of particles to points nearby. */
#ifndef HOODOO_CLOSEST_H
#define HOODOO_CLOSEST_H

#include <stddef.h>

#include "base/status.h"

/* out[i] = the value of the particle closest to point i, or 0 if no particle is within `reach`. Of two particles at the same
 * distance the first one counts. point is [n_points][3], particle [n_particles][4] (x, y, z, ignored), both in m.
 * E_INPUT: a position is not finite, or the particles span too many cells. E_MEMORY. */
MUST_USE status closest_values(const float *point, size_t n_points, const float *particle, const float *value,
                               size_t n_particles, double reach, float *out);

#endif
