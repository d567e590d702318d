/* The point of a triangle mesh that is nearest to a given point. */
#ifndef HOODOO_MESHINPUT_NEAREST_H
#define HOODOO_MESHINPUT_NEAREST_H

#include <stdbool.h>

#include "meshinput/mesh.h"

struct nearest;

/* The mesh must outlive *out, unchanged, and have a triangle. E_MEMORY. */
MUST_USE status nearest_create(const struct mesh *mesh, struct nearest **out);
void nearest_destroy(struct nearest **nearest);

struct nearest_point {
    uint32_t triangle;
    double weight[3]; /* barycentric: of the triangle's corners, of sum 1 */
    double distance;  /* m */
};

/* False if the mesh is farther than `within` m from x. Of triangles that are equally near, the first in the mesh. Thread-safe. */
bool nearest_find(const struct nearest *nearest, const double x[3], double within, struct nearest_point *out);

#endif
