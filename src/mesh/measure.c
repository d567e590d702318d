#include <math.h>
#include <string.h>

#include "base/vector.h"
#include "mesh/apart.h"
#include "mesh/boxes.h"

/* Serial, in the order of the triangles, so that sums are reproducible. */
void trimesh_normals(const struct trimesh *mesh, float *normal)
{
    memset(normal, 0, 3 * mesh->n_vertices * sizeof *normal);
    for (size_t t = 0; t < mesh->n_triangles; t++) {
        const uint32_t *c = mesh->triangle + 3 * t;
        double x[3][3], e[3][3], n[3];
        boxes_corners(mesh, c, x);
        for (int k = 0; k < 3; k++)
            minus3(x[(k + 1) % 3], x[k], e[k]);
        cross3(e[0], e[1], n);
        double area2 = sqrt(dot3(n, n));
        for (int k = 0; k < 3 && area2 > 0; k++) {
            double angle = atan2(area2, -dot3(e[k], e[(k + 2) % 3]));
            for (int d = 0; d < 3; d++)
                normal[3 * (size_t)c[k] + (size_t)d] += (float)(angle * n[d] / area2);
        }
    }
    for (size_t v = 0; v < mesh->n_vertices; v++) {
        float *n = normal + 3 * v, length = sqrtf(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
        for (int d = 0; d < 3 && length > 0; d++)
            n[d] /= length;
    }
}

double trimesh_volume(const struct trimesh *mesh)
{
    double sum = 0;
    for (size_t t = 0; t < mesh->n_triangles; t++) {
        double x[3][3], n[3];
        boxes_corners(mesh, mesh->triangle + 3 * t, x);
        cross3(x[1], x[2], n);
        sum += dot3(x[0], n);
    }
    return sum / 6;
}
