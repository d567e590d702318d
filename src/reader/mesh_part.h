/* Meshes as their readers answer them: hoodoo-read-mesh (glTF: meshinput/import_shim.cpp) and hoodoo-read (the surfaces of
 * OpenVDB grids: vdb/shape_shim.cpp).
 *
 * mesh FORMAT          struct mesh_part, its corners double[n_vertices][3], its triangles uint32[n_triangles][3]
 * vdb.shape GRID ISO   the same; GRID may be "", for the only or first one that has floats
 */
#ifndef HOODOO_MESH_PART_H
#define HOODOO_MESH_PART_H

#include <stdint.h>

struct mesh_part {
    uint64_t n_vertices, n_triangles;
    uint32_t y_up, is_fog; /* of OpenVDB's: what the file says */
    char grid[64];         /* of OpenVDB's: its name, cut where it is longer */
};

#endif
