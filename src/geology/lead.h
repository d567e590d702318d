/* The speed of a weathering front along sheets of rock that are thinner than a voxel: soft sheets lead.
 *
 * Across sheets times add up, and the speed is the harmonic mean. Along sheets the softest is ahead and its neighbours are reached from
 * their flanks: far from the start the speed tends to that of the softest, and before that it is lower. The power mean of the rates with
 * exponent LEAD_POWER fits fronts through beds a tenth of a voxel thick, over up to ten voxels (tests/physics/beds.h). Being a mean, it
 * is the same for a voxel and for its eight parts together.
 */
#ifndef HOODOO_LEAD_H
#define HOODOO_LEAD_H

#include <math.h>

#define LEAD_POWER 8

/* The factor on the rate of rock of which this share is in sheets that weather `rate` times faster. */
static inline double lead_mean(double rate, double share)
{
    return rate == 1 || share == 0 ? 1 : pow(1 + share * (pow(rate, LEAD_POWER) - 1), 1.0 / LEAD_POWER);
}

#endif
