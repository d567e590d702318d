#include "shape/noise.h"

#include <math.h>

#include "base/random.h"

/* One octave's standard deviation is 1 / 3.7032: sqrt(16 A A B), with A and B the means over 0..1 of (1 -
 * fade(t))^2 and t^2 (1 - fade(t))^2, since an edge gradient's mean square along any axis is 2/3. */
#define OCTAVE_TO_UNIT 3.70322252707401

struct noise noise_init(const struct job_noise *job, uint32_t seed)
{
    struct noise n = {
        .octaves = (int)(job->octaves < NOISE_MAX_OCTAVES ? job->octaves : NOISE_MAX_OCTAVES),
        .per_metre = {1 / job->scale_m, 1 / job->scale_m, job->flatten / job->scale_m},
    };
    double variance = 0;
    for (int o = 0; o < n.octaves; o++) {
        n.seed[o] = random_hash(seed, (uint32_t)o, 0, RANDOM_NOISE);
        for (uint32_t a = 0; a < 3; a++)
            n.shift[o][a] = 64 * (double)random_float(random_hash(seed, (uint32_t)o, a + 1, RANDOM_NOISE));
        variance += pow(0.25, o);
    }
    n.scale = n.octaves > 0 ? OCTAVE_TO_UNIT / sqrt(variance) : 0;
    return n;
}

/* The dot product of d with one of the gradients (+-1, +-1, 0), (+-1, 0, +-1), (0, +-1, +-1). */
static double along_gradient(uint32_t hash, const double d[3])
{
    uint32_t edge = (uint32_t)(((uint64_t)hash * 12) >> 32);
    uint32_t axis = edge >> 2;
    double u = d[axis == 2 ? 1 : 0], v = d[axis == 0 ? 1 : 2];
    return (edge & 1 ? -u : u) + (edge & 2 ? -v : v);
}

static double fade(double t)
{
    return t * t * t * (t * (t * 6 - 15) + 10);
}

static double octave(uint32_t seed, const double x[3])
{
    uint32_t cell[3];
    double t[3], f[3], sum = 0;
    for (int a = 0; a < 3; a++) {
        double low = floor(x[a]);
        cell[a] = (uint32_t)(int64_t)low;
        t[a] = x[a] - low;
        f[a] = fade(t[a]);
    }
    for (uint32_t corner = 0; corner < 8; corner++) {
        const uint32_t at[3] = {corner & 1, corner >> 1 & 1, corner >> 2};
        double d[3], weight = 1;
        for (int a = 0; a < 3; a++) {
            d[a] = t[a] - (double)at[a];
            weight *= at[a] ? f[a] : 1 - f[a];
        }
        sum +=
            weight * along_gradient(random_hash(seed, cell[0] + at[0], cell[1] + at[1], cell[2] + at[2]), d);
    }
    return sum;
}

double noise_at(const struct noise *noise, const double x[3])
{
    double sum = 0, size = 1;
    for (int o = 0; o < noise->octaves; o++, size *= 0.5) {
        double p[3];
        for (int a = 0; a < 3; a++)
            p[a] = x[a] * noise->per_metre[a] / size + noise->shift[o][a];
        sum += size * octave(noise->seed[o], p);
    }
    return sum * noise->scale;
}
