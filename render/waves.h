/* Noise as a sum of waves whose lengths are in metres and fixed in the world, so that rock has the same roughness in scenes of any size. */
#ifndef HOODOO_WAVES_H
#define HOODOO_WAVES_H

#include "shape/noise.h"

enum { WAVES = 10 };

struct waves {
    double length[WAVES]; /* m, descending */
    size_t n;
    struct noise noise[WAVES];
};

/* n waves: the first has the length `longest` (m), each following one `ratio` (below 1) times the length before. Different `use` gives
 * independent waves. */
struct waves waves_make(double longest, double ratio, size_t n, uint32_t use);

/* Wave i at a place, with zero mean and unit variance. */
double wave_at(const struct waves *w, size_t i, const double x[3]);

/* Smoothstep: 0 below `low`, 1 above `high`. */
double ramp(double low, double high, double x);

#endif
