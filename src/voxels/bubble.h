/* Bubbles: the shapes whose share of air says how fast a voxel weathers (Goblins, section 4), as tables of
 * rows.
 *
 * A bubble is a convex set of whole voxels around its own, so that along x each of its rows is one run of at
 * most 31: one masked word. Rates are scaled so that a flat face of the layer, whichever way it looks,
 * retreats on the average at the speed the job gives, however large its voxels.
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
    uint32_t n;        /* voxels in all */
    struct bubble_row row[BUBBLE_ROWS_MAX];
};

/* E_USAGE: it holds no neighbour at this voxel size h, or reaches farther than BUBBLE_REACH_MAX voxels. */
MUST_USE status bubble_create(const struct job_bubble *job, double h, struct bubble *out);

/* What the number of its voxels that are air does to the rate: w = max(0, slope * air - level), so that over
 * the six flat faces the voxels of a skin `depth` deep retreat 1 voxel in unit time together. `threshold` is
 * the share of a flat face's air below which nothing weathers. */
struct bubble_rate {
    double slope, level;
};
struct bubble_rate bubble_rate(const struct bubble *b, double threshold, int depth);

#endif
