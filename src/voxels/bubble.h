/* Bubbles: the neighbourhoods whose share of air determines how fast a voxel weathers (Goblins, section 4), as tables of rows.
 *
 * A bubble is a convex set of voxels around a voxel, so each of its rows along x is one run of at most 31 voxels: one masked word.
 * Rates are scaled so that, without a threshold, a flat face retreats at the speed that the job gives, averaged over the six axis
 * directions, whatever the size of the voxels.
 */
#ifndef HOODOO_BUBBLE_H
#define HOODOO_BUBBLE_H

#include <stdint.h>

#include "base/status.h"
#include "job/job.h"

/* Per area, a skin of SKIN_EVEN voxels has 3, 2.83 and 2.89 voxels below faces across one, two and three axes: these retreat most
 * evenly. (Of 2 voxels: 2, 1.41, 1.73; of 4: 4, 3.54, 3.46.) */
enum { BUBBLE_REACH_MAX = 15, BUBBLE_ROWS_MAX = 31 * 31, SKIN_EVEN = 3, SKIN_MAX = 4 };

struct bubble_row {
    int8_t dy, dz, low, high; /* voxels low..high along x */
};

struct bubble {
    int n_rows, reach; /* voxels, in y or z */
    uint32_t n;        /* voxels in total */
    struct bubble_row row[BUBBLE_ROWS_MAX];
};

/* E_USAGE: at this voxel size h (m) it contains no neighbour, or reaches farther than BUBBLE_REACH_MAX voxels. */
MUST_USE status bubble_create(const struct job_bubble *job, double h, struct bubble *out);

/* Rate as a function of the number of air voxels in the bubble: w = max(0, slope * air - level), 1 for a face that retreats by its voxel's
 * size per unit of time. In the limit of small voxels, the sum of w over a skin of `depth` voxels is air / air_f - threshold, where air_f
 * is the share of air on a flat face itself (the mean of those of its outermost voxel and the first voxel of air), averaged over the six
 * faces. Below a flat face the sum is 1 - threshold for voxels of any size, unless w is 0 in some of the skin; for curved faces it is second-order
 * accurate in the voxel size, so that neither shape nor speed depends on it. */
struct bubble_rate {
    double slope, level;
};
struct bubble_rate bubble_rate(const struct bubble *b, double threshold, int depth);

#endif
