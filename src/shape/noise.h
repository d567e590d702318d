/* Gradient noise: smooth variation with position, for the strength of rock.
 *
 * Per octave, classic gradient noise with the twelve edge gradients and the quintic fade (Perlin, Improving
 * Noise, SIGGRAPH 2002), its corners' gradients chosen by random_hash(octave's seed, i, j, k) instead of a
 * table, and its lattice shifted by a hash of the seed, since noise is zero at the corners and octaves must
 * not share them. Octave o has 2^-o of the size and strength of the first. The sum is scaled to unit
 * variance; its mean is zero.
 */
#ifndef HOODOO_SHAPE_NOISE_H
#define HOODOO_SHAPE_NOISE_H

#include <stdint.h>

#include "job/job.h"

enum { NOISE_MAX_OCTAVES = 8 };

struct noise {
    int octaves;
    double per_metre[3]; /* lattice cells a metre: fewer in x and y than in z when flattened */
    double scale;        /* to unit variance */
    uint32_t seed[NOISE_MAX_OCTAVES];
    double shift[NOISE_MAX_OCTAVES][3];
};

struct noise noise_init(const struct job_noise *job, uint32_t seed);

/* A function of position in metres and the seed alone. */
double noise_at(const struct noise *noise, const double x[3]);

#endif
