/* Triangle meshes from OBJ and PLY files, read as if somebody had prepared them to hurt. */
#ifndef HOODOO_MESHFILE_H
#define HOODOO_MESHFILE_H

#include <stddef.h>
#include <stdint.h>

#include "base/status.h"

struct mesh {
    size_t n_vertices, n_triangles;
    double (*vertex)[3];     /* finite */
    uint32_t (*triangle)[3]; /* every index < n_vertices */
    size_t vertex_capacity, triangle_capacity;
};

/* Reads `path` by its content: PLY (ascii, binary of either byte order) if it starts so, else OBJ. Polygons
 * become fans. E_INPUT: file:line (or byte), and what is wrong. *mesh is the caller's to mesh_free(). */
MUST_USE status mesh_read(const char *path, struct mesh *mesh);
void mesh_free(struct mesh *mesh);

/* Joins vertices at equal positions and drops triangles without three corners. */
MUST_USE status mesh_weld(struct mesh *mesh);

#endif
