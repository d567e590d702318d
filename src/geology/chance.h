/* Hashed random numbers for counted things: beds, laminae, joints, concretions. */
#ifndef HOODOO_CHANCE_H
#define HOODOO_CHANCE_H

#include <math.h>

#include "base/random.h"

/* The hash seed of a set of things. */
static inline uint32_t chance_seed(int64_t job_seed, int64_t own_seed, uint32_t list_index,
                                   enum random_purpose purpose)
{
    return random_hash((uint32_t)job_seed, (uint32_t)own_seed, list_index, (uint32_t)purpose);
}

/* Uniform in [0, 1), for thing (i, j) of the set. `what` distinguishes its numbers. */
static inline double chance(uint32_t seed, int64_t i, int64_t j, uint32_t what)
{
    return (double)random_float(random_hash(seed, (uint32_t)i, (uint32_t)j, what));
}

/* Standard normal (Box-Muller). */
static inline double chance_normal(uint32_t seed, int64_t i, int64_t j, uint32_t what)
{
    const double u = chance(seed, i, j, 2 * what + 1000), v = chance(seed, i, j, 2 * what + 1001);
    return sqrt(-2 * log(1 - u)) * cos(2 * M_PI * v);
}

#endif
