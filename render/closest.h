/* Values of particles, taken to points near them. */
#ifndef HOODOO_CLOSEST_H
#define HOODOO_CLOSEST_H

#include <stddef.h>

#include "base/status.h"

/* out[i] = the value of the particle closest to point i, of those closer than `reach`; 0 if none is. Of two as close the one
 * that comes first. point is [n_points][3], particle [n_particles][4] (x, y, z, anything), both in m. */
MUST_USE status closest_values(const float *point, size_t n_points, const float *particle, const float *value,
                               size_t n_particles, double reach, float *out);

#endif
