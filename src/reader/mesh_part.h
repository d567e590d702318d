/* How readers answer with a mesh: hoodoo-read-mesh (meshinput/serve.c) and hoodoo-read (surfaces of OpenVDB grids: vdb/shape_shim.cpp).
 *
 * mesh ATTRIBUTE (NAME SIZE)...  struct mesh_part, vertices double[n_vertices][3], triangles uint32[n_triangles][3]; unless ATTRIBUTE is
 *                                "", its values float[n_vertices]. Input: the bytes of a glTF file's buffers NAME, one behind the other
 * vdb.shape GRID ISO             struct mesh_part, vertices, triangles; if GRID is "", the first grid of floats
 */
#ifndef HOODOO_MESH_PART_H
#define HOODOO_MESH_PART_H

#include <stdint.h>

struct mesh_part {
    uint64_t n_vertices, n_triangles;
    uint32_t y_up;   /* as the format prescribes (glTF) or the metadata say (OpenVDB) */
    uint32_t is_fog; /* OpenVDB only */
    char grid[64];   /* OpenVDB only: name of the grid, truncated if it is longer */
};

#endif
