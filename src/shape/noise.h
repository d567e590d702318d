/* Gradient noise: smooth variation with position, for the strength of rock, paint and formulas.
 *
 * Each octave is classic gradient noise with the twelve edge gradients and the quintic fade (Perlin, Improving Noise, SIGGRAPH 2002). The
 * gradients of lattice points are chosen by random_hash(octave's seed, i, j, k) instead of a permutation table. The lattices of octaves
 * are shifted against each other by hashes of the seed, for noise is 0 at lattice points. Octave o has 2^-o of the size and amplitude of
 * the first. The sum is scaled to unit variance; its mean is zero.
 */
#ifndef HOODOO_SHAPE_NOISE_H
#define HOODOO_SHAPE_NOISE_H

#include <stdint.h>

#include "job/job.h"

enum { NOISE_MAX_OCTAVES = 8 };

struct noise {
    int octaves;
    double per_metre[3]; /* lattice cells per metre; more in z than in x and y if flattened */
    double scale;        /* from the sum of octaves to unit variance */
    uint32_t seed[NOISE_MAX_OCTAVES];
    double shift[NOISE_MAX_OCTAVES][3];
};

struct noise noise_init(const struct job_noise *job, uint32_t seed);

/* The noise at a position in metres; depends on position and seed only. */
double noise_at(const struct noise *noise, const double x[3]);

#endif
