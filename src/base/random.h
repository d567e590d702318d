/* Random numbers without a generator: each is a hash of its purpose and indices.
 *
 * Equal arguments give equal bits on every machine and in every thread order, and there is no state to save.
 * Kernels compute the same numbers (shaders/shared/random.glsl; unsigned integers wrap in both languages).
 * Source   pcg4d, Jarzynski and Olano, Hash Functions for GPU Rendering, JCGT 9(3), 2020.
 */
#ifndef HOODOO_RANDOM_H
#define HOODOO_RANDOM_H

#include <stdint.h>

/* The purpose of a number, which keeps the numbers of different uses independent. Do not renumber: results would change. */
enum random_purpose {
    RANDOM_JITTER = 1,
    RANDOM_NOISE = 2,
    RANDOM_ESTIMATE = 3,
    RANDOM_WATER = 4,
    RANDOM_DEPOSIT = 5,
    RANDOM_PLANTS = 6,
    RANDOM_PILES = 7,
    RANDOM_FUNCTION = 9,
    RANDOM_PAINT = 20,
    RANDOM_BEDS = 21,
    RANDOM_JOINTS = 22,
    RANDOM_CONCRETIONS = 23,
    RANDOM_SHEETS = 24
};

/* 32 random bits, each of which depends on every argument. Nest calls for more than four arguments. */
static inline uint32_t random_hash(uint32_t a, uint32_t b, uint32_t c, uint32_t d)
{
    a = a * 1664525u + 1013904223u;
    b = b * 1664525u + 1013904223u;
    c = c * 1664525u + 1013904223u;
    d = d * 1664525u + 1013904223u;
    a += b * d;
    b += c * a;
    c += a * b;
    d += b * c;
    a ^= a >> 16;
    b ^= b >> 16;
    c ^= c >> 16;
    d ^= d >> 16;
    a += b * d;
    b += c * a;
    c += a * b;
    d += b * c;
    return d;
}

/* Uniform in [0, 1), from the top 24 bits, which a float represents exactly. */
static inline float random_float(uint32_t hash)
{
    return (float)(hash >> 8) * (1.0f / 16777216.0f);
}

#endif
