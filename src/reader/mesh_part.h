/* How readers answer with a mesh: hoodoo-read-mesh (glTF: meshinput/import_shim.cpp) and hoodoo-read (surfaces of OpenVDB grids:
 * vdb/shape_shim.cpp).
 *
 * mesh FORMAT          struct mesh_part, vertices double[n_vertices][3], triangles uint32[n_triangles][3]
 * vdb.shape GRID ISO   the same; if GRID is "", the first grid of floats
 */
#ifndef HOODOO_MESH_PART_H
#define HOODOO_MESH_PART_H

#include <stdint.h>

struct mesh_part {
    uint64_t n_vertices, n_triangles;
    uint32_t y_up, is_fog; /* OpenVDB only: as the file's metadata say */
    char grid[64];         /* OpenVDB only: name of the grid, truncated if it is longer */
};

#endif
