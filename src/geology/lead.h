/* How fast a front runs along sheets of rock that are thinner than a voxel: soft ones lead.
 *
 * Where a front crosses sheets time adds up, and its speed is their harmonic mean. Where it runs along them the softest is ahead, and
 * what lies beside is reached from its flank; the speed tends to the softest's far in, and is less as long as flanks take their time.
 * The mean of the rates to LEAD_POWER is what fronts had that ran through beds a tenth as thick as the voxels, for as far as ten
 * voxels (tests/physics/beds.h), and it is a mean of voxels' too: the same for one voxel and for the eight within it.
 */
#ifndef HOODOO_LEAD_H
#define HOODOO_LEAD_H

#include <math.h>

#define LEAD_POWER 8

/* Of rock of which this share is in sheets that weather so many times faster; 1: as the rest. */
static inline double lead_mean(double rate, double share)
{
    return rate == 1 || share == 0 ? 1 : pow(1 + share * (pow(rate, LEAD_POWER) - 1), 1.0 / LEAD_POWER);
}

#endif
