/* Divides the rock of a voxel among the smaller voxels in it.
 *
 * The rock is taken to lie below a plane (piecewise linear interface construction: Youngs, Time-dependent multi-material flow with large
 * fluid distortion, 1982), so that a surface of partly filled voxels stays where it is at the smaller size, and the volume of each voxel
 * stays the same. */
#ifndef HOODOO_SPLIT_H
#define HOODOO_SPLIT_H

enum { SPLIT_MOST = 8 }; /* the largest k */

/* The outward normal of the rock in a voxel, from the shares of rock in it and its neighbours: fill[9 (z + 1) + 3 (y + 1) + (x + 1)], each
 * offset -1, 0 or 1. Zero if they have no gradient. Not normalised. */
void split_normal(const double fill[27], double normal[3]);

/* The share of a box below a plane: of the points x of the box of side s whose lowest corner is `low`, those with normal . x <= d. */
double split_below(const double normal[3], double d, const double low[3], double s);

/* Gives each of the k^3 voxels (x fastest), which had the share most[i] of rock at first, its share of the rock `fill` of the large voxel,
 * which had `first` at first. If it has less now, the plane cuts it, and the mean of share[] is `fill`; otherwise each voxel still has
 * most[i], and what has been added since is spread over what is free. `first` 0: the rock was not there at first, and most[] is not
 * used. No share is between 0 and `least`. k is at most SPLIT_MOST. */
void split_voxel(int k, double fill, double first, const double normal[3], const float *most, double least,
                 float *share);

#endif
