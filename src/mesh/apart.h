/* Do two triangles meet only where they share corners? Conservative: true is certain, false may be doubt. */
#ifndef HOODOO_MESH_APART_H
#define HOODOO_MESH_APART_H

#include <stdbool.h>

/* The first `shared` corners of both are the same (0 to 3). */
bool triangles_apart(const double a[3][3], const double b[3][3], int shared);

/* The square of p's distance to the triangle. */
double triangle_distance2(const double p[3], const double t[3][3]);

#endif
