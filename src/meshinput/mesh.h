/* A triangle mesh as a file has it. */
#ifndef HOODOO_MESHINPUT_MESH_H
#define HOODOO_MESHINPUT_MESH_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "base/status.h"

#ifdef __cplusplus
extern "C" {
#endif

struct mesh {
    size_t n_vertices, n_triangles;
    double (*vertex)[3];     /* finite */
    uint32_t (*triangle)[3]; /* every index < n_vertices */
    float *value;            /* [n_vertices], finite: the attribute that was asked for; or NULL */
    size_t n_values;         /* n_vertices, when it is complete */
    size_t vertex_capacity, triangle_capacity, value_capacity;
    bool y_up; /* the file's format prescribes it */
};

/* E_MEMORY; E_INPUT: more than 2^32 - 1 vertices. */
MUST_USE status mesh_add_vertex(struct mesh *mesh, const double x[3]);
MUST_USE status mesh_add_triangle(struct mesh *mesh, uint32_t a, uint32_t b, uint32_t c);

/* Adds the value of the next vertex. E_MEMORY. */
MUST_USE status mesh_add_value(struct mesh *mesh, double value);

void mesh_free(struct mesh *mesh);

/* Joins vertices at equal positions and drops triangles that then have fewer than three corners. E_MEMORY. */
MUST_USE status mesh_weld(struct mesh *mesh);

#ifdef __cplusplus
}
#endif
#endif
