/* Noise as waves of given lengths in metres, fixed in the world: the same rock is as rough in every picture, however large the scene. */
#ifndef HOODOO_WAVES_H
#define HOODOO_WAVES_H

#include "shape/noise.h"

enum { WAVES = 10 };

struct waves {
    double length[WAVES]; /* m, from long to short */
    size_t n;
    struct noise noise[WAVES];
};

/* n lengths from the longest on, each `ratio` (below 1) of the one before. `use` tells waves of different things apart. */
struct waves waves_make(double longest, double ratio, size_t n, uint32_t use);

/* One of them, of unit variance. */
double wave_at(const struct waves *w, size_t i, const double x[3]);

/* 0 below `low`, 1 above `high`, smooth between. */
double ramp(double low, double high, double x);

#endif
