/* The points at which voxels are probed for the share of them that is inside a shape. */
#ifndef HOODOO_SHAPE_PROBES_H
#define HOODOO_SHAPE_PROBES_H

enum { PROBES = 64 };

/* Coordinate a of probe i in the unit voxel. The 64 probes are a rank-1 lattice: as many as in a 4 x 4 x 4 grid, but with 64 different
 * coordinates on each axis instead of 4, so that axis-aligned faces are resolved to h/64. Slanted planes are more accurate, too (rms
 * error 1.7 % of the voxel instead of 2.0 %). */
static inline double probe(int i, int a)
{
    static const int step[3] = {1, 47, 57};
    return ((i * step[a]) % PROBES + 0.5) / PROBES;
}

#endif
