/* The solid of a frame of hoodoo's, recovered from its volumes. */
#ifndef HOODOO_VDB_SOLID_HPP
#define HOODOO_VDB_SOLID_HPP

#include "vdb/shim.hpp"

#include <vector>

namespace vdb
{
/* A function that is negative inside, by its values at the samples near the surface, trilinear between them. */
struct solid {
    double voxel, origin[3];  /* m, z up: sample (i, j, k) is at origin + (i, j, k) voxel */
    double filled;            /* voxels: the solid's volume */
    std::vector<int32_t> at;  /* three for each sample */
    std::vector<float> value; /* voxels: a lower bound of the distance */
};

/* False: the file is not a frame's volumes by hoodoo. */
bool find_solid(const file &file, solid *out);
} // namespace vdb

#endif
