/* Reads triangle meshes from files, which may be hostile. OBJ, PLY, STL and OFF are parsed here, glTF and GLB in hoodoo-read-mesh
 * (assimp). Debian's assimp stores coordinates as 32-bit floats: enough for glTF, whose coordinates are floats, but not for the map
 * coordinates that the other formats may have. */
#ifndef HOODOO_MESHINPUT_MESH_H
#define HOODOO_MESHINPUT_MESH_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "base/status.h"

struct mesh {
    size_t n_vertices, n_triangles;
    double (*vertex)[3];     /* finite */
    uint32_t (*triangle)[3]; /* every index < n_vertices */
    size_t vertex_capacity, triangle_capacity;
    bool y_up; /* the file's format prescribes it */
};

/* Reads `path`, whose format is recognised by its content (OBJ if the content does not tell). Polygons become triangle fans. Free *mesh
 * with mesh_free(). E_INPUT: file, line or byte and what is wrong; for other formats, which it is and how to convert it. E_MEMORY. */
MUST_USE status mesh_read(const char *path, struct mesh *mesh);
void mesh_free(struct mesh *mesh);

/* Joins vertices at equal positions and drops triangles that then have fewer than three corners. E_MEMORY. */
MUST_USE status mesh_weld(struct mesh *mesh);

#endif
