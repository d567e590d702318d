/* Divides the rock of a voxel among the k^3 smaller voxels in it, which are numbered with x fastest. */
#ifndef HOODOO_SPLIT_H
#define HOODOO_SPLIT_H

#include <stddef.h>

enum { SPLIT_MOST = 8, SPLIT_VOXELS = SPLIT_MOST * SPLIT_MOST * SPLIT_MOST }; /* the largest k, and its k^3 */

/* The share of a box below a plane: of the points x of the box of side s whose lowest corner is `low`, those with normal . x <= d. */
double split_below(const double normal[3], double d, const double low[3], double s);

/* The share of the small voxel e that is rock, where rock is what has more than `level` of the quadratic B-spline through the shares of
 * the voxel and its neighbours, fill[9 (z + 1) + 3 (y + 1) + (x + 1)]: a surface that is smooth across voxels, and at level 1/2 lies where
 * a plane face has it. In the small voxel it is replaced by a plane. */
double split_smooth(const double fill[27], double level, int k, int e);

/* Shares of n voxels, of which each had most[i] at first and all together the mean share `first` as the large voxel has it: they now have the
 * mean share `fill` if that is less, all reduced alike; otherwise they are as they were, and what has been added is spread over what is
 * free. `first` 0: the rock was not there at first, and most[] is not used. */
void split_evenly(size_t n, double fill, double first, const float *most, float *share);

#endif
