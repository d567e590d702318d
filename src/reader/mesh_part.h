/* How readers answer with a mesh: hoodoo-read-mesh (meshinput/serve.c) and hoodoo-read (surfaces of OpenVDB grids: vdb/shape_shim.cpp).
 *
 * mesh ATTRIBUTE (NAME SIZE)...  struct mesh_part, vertices double[n_vertices][3], triangles uint32[n_triangles][3]; unless ATTRIBUTE is
 *                                "", its values float[n_vertices]. Input: the bytes of a glTF file's buffers NAME, one behind the other
 * vdb.shape GRID ISO             struct mesh_part, vertices, triangles; if GRID is "", the first grid of floats. Of volumes of a frame of
 *                                hoodoo's, if GRID is "": struct mesh_part, struct solid_part, positions int32[n][3], values float[n]
 */
#ifndef HOODOO_MESH_PART_H
#define HOODOO_MESH_PART_H

#include <stdint.h>

struct mesh_part {
    uint64_t n_vertices, n_triangles;
    uint32_t y_up;      /* as the format prescribes (glTF) or the metadata say (OpenVDB) */
    uint32_t is_fog;    /* OpenVDB only */
    uint32_t is_solid;  /* OpenVDB only: struct solid_part follows instead of a mesh */
    uint32_t n_choices; /* OpenVDB only: grids of that name or, if none was given, grids of floats */
    char grid[64];      /* OpenVDB only: name of the grid, truncated if it is longer */
};

/* A solid as the values of a function at samples near its surface, negative inside, trilinear between them: voxels, a lower bound of the
 * distance. Sample (i, j, k) is at origin + (i, j, k) voxel, in m, z up. */
struct solid_part {
    uint64_t n;
    double voxel, origin[3];
    double filled; /* the solid's volume, voxels */
};

#endif
