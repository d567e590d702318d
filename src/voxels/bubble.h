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

enum { BUBBLE_REACH_MAX = 15, BUBBLE_ROWS_MAX = 31 * 31, SKIN_MAX = 4 };

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

/* Rate as a function of the number of air voxels in the bubble: w = max(0, slope * air - level). Without a threshold, w summed
 * over a skin of `depth` voxels below a flat face is 1, averaged over the six faces. The threshold is a share of the air count on
 * the flat face itself, the mean of those of the outermost voxel and the first voxel of air. Both are second-order accurate in the
 * voxel size, so that neither shape nor speed depends on it. */
struct bubble_rate {
    double slope, level;
};
struct bubble_rate bubble_rate(const struct bubble *b, double threshold, int depth);

#endif
