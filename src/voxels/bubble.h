/* Bubbles: the shapes whose share of air says how fast a voxel weathers (Goblins, section 4), as tables of
 * rows.
 *
 * A bubble is a convex set of whole voxels around its own, so that along x each of its rows is one run of at
 * most 31: one masked word. Rates are scaled so that, without a threshold, a flat face retreats at
 * the speed the job gives, on the average over the ways it may look, however large its voxels.
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

/* What the number of its voxels that are air does to the rate: w = max(0, slope * air - level), in voxels of
 * retreat. Without a threshold the voxels of a skin `depth` deep below a flat face make up 1 together, on the
 * average over the six. The threshold is a share of the air on a flat face itself, between its outermost
 * voxels and the first of the air. Both are what a bubble of infinitely small voxels has, to second order, so
 * that neither shape nor speed depends on their size. */
struct bubble_rate {
    double slope, level;
};
struct bubble_rate bubble_rate(const struct bubble *b, double threshold, int depth);

#endif
