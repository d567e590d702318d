#include "render/waves.h"

#include <math.h>

struct waves waves_make(double longest, double ratio, size_t n, uint32_t use)
{
    struct waves w = {.n = n < WAVES ? n : WAVES};
    double length = longest;
    for (size_t i = 0; i < w.n; i++, length *= ratio) {
        const struct job_noise one = {.scale_m = length, .octaves = 1, .flatten = 1};
        w.length[i] = length;
        w.noise[i] = noise_init(&one, 1000 * use + (uint32_t)i);
    }
    return w;
}

double wave_at(const struct waves *w, size_t i, const double x[3])
{
    return noise_at(&w->noise[i], x);
}

double ramp(double low, double high, double x)
{
    double t = fmin(fmax((x - low) / (high - low), 0), 1);
    return t * t * (3 - 2 * t);
}
