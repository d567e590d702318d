/* Whether two triangles meet only where they share corners. Conservative: true is certain, false may only mean doubt. */
#ifndef HOODOO_MESH_APART_H
#define HOODOO_MESH_APART_H

#include <stdbool.h>

/* `shared` is the number of common corners (0 to 3), which come first in both triangles. */
bool triangles_apart(const double a[3][3], const double b[3][3], int shared);

/* The squared distance of p from the triangle. */
double triangle_distance2(const double p[3], const double t[3][3]);

#endif
