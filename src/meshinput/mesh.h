/* Triangle meshes from files, read as if somebody had prepared them to hurt: OBJ, PLY, STL and OFF here, glTF and
 * GLB by hoodoo-read-mesh (assimp). Debian's assimp keeps coordinates as 32-bit floats, which is what glTF
 * has; those of maps do not fit into them. */
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
    bool y_up; /* so says the file's format */
};

/* Reads `path` by its content, as OBJ if that says nothing. Polygons become fans. E_INPUT: file:line (or byte), and what is wrong; of
 * kinds that nobody here reads, what they are and how to convert them. *mesh is the caller's to mesh_free(). */
MUST_USE status mesh_read(const char *path, struct mesh *mesh);
void mesh_free(struct mesh *mesh);

/* Joins vertices at equal positions and drops triangles without three corners. */
MUST_USE status mesh_weld(struct mesh *mesh);

#endif
