/* Triangle meshes of surfaces: closed, manifold, oriented outwards and free of self-intersections by construction.
 *
 * March      Marching cubes (Lorensen and Cline 1987) on samples without ambiguous faces. A face of a cell is ambiguous if its two
 *            inside corners lie on a diagonal. Then the outside corner that is nearest to the surface is made inside, which joins the
 *            two, until no ambiguous face is left. In the remaining cases every polygon, seen along the direction from its inside to
 *            its outside corners, is convex with its corners on the outline of the cell. Therefore no triangulation of the polygons has
 *            intersections, no triangle lies in a face of a cell, and neighbouring cells meet only in the segments on their common
 *            face. (Where two corners at opposite ends of a cell are cut off, their triangles lie on different sides of its centre.)
 *            Vertices keep a distance from samples (TRIMESH_CLEARANCE), so that no triangle degenerates to a point. Vertices with
 *            equal lattice coordinates have equal floats, so rounding does not affect any of this.
 * Smooth     Taubin's filter (1995), two steps of opposite sign, along the normals; the volume is preserved. See trimesh_smooth().
 * Simplify   Edge collapses of a vertex into a neighbour, while every vertex of the original surface stays within a tolerance of the
 *            simplified one.
 *
 * Smoothing and simplification undo or refuse changes that would make triangles intersect; triangles that are close to each other are
 * tested with separating axes (apart.h). The same input gives the same bits with any number of threads.
 */
#ifndef HOODOO_TRIMESH_H
#define HOODOO_TRIMESH_H

#include <stddef.h>
#include <stdint.h>

#include "base/status.h"

#ifdef __cplusplus
extern "C" {
#endif

struct trimesh {
    size_t n_vertices, n_triangles;
    float *vertex;      /* [n_vertices][3] m */
    uint32_t *triangle; /* [n_triangles][3], counter-clockwise from outside */
};

/* The least distance of a vertex from a sample, as a share of the length of a cell's edge. */
#define TRIMESH_CLEARANCE (1.0 / 64)

struct trimesh_lattice {
    int n[3]; /* samples, numbered (k ny + j) nx + i */
    double voxel, origin[3];
};

/* The surface between samples of `field` that are below 0 and the others. Samples that are not finite, and the outermost samples, count
 * as outside. Changes `field` at ambiguous faces. out is freed with trimesh_free(). E_INPUT: the lattice is so far from the origin that
 * floats cannot represent the vertices, or there are more than 2^32 vertices. */
MUST_USE status trimesh_march(float *field, const struct trimesh_lattice *lattice, struct trimesh *out);
void trimesh_free(struct trimesh *mesh);

/* Smooths in `passes` passes; vertices move along their normals by at most `reach` m. label[n_vertices] may be NULL. A vertex at a
 * border between two labels is smoothed only with its neighbours on the same border, other vertices only with neighbours of their own
 * label. Neighbours whose normals differ by more than 20 degrees do not affect each other, so sharp edges stay. */
MUST_USE status trimesh_smooth(struct trimesh *mesh, const uint32_t *label, int passes, double reach);

/* Removes vertices, each of which is within `tolerance` m of the resulting surface. Remaining vertices do not move; (*kept)[i] is the
 * previous index of vertex i, freed with free(). Vertices at a border between labels (label[n_vertices], or NULL) are not removed. No
 * new edge is longer than `longest` m. */
MUST_USE status trimesh_simplify(struct trimesh *mesh, const uint32_t *label, double tolerance,
                                 double longest, uint32_t **kept);

/* Counts the pairs of triangles that intersect or touch other than in a shared vertex or edge. 0 for the results of the functions above;
 * for meshes from elsewhere. */
MUST_USE status trimesh_crossings(const struct trimesh *mesh, size_t *n);

/* Unit normals of the vertices, normal[n_vertices][3]: the average of the adjacent triangles' normals, weighted by their angles. */
void trimesh_normals(const struct trimesh *mesh, float *normal);

/* The enclosed volume in m3. */
double trimesh_volume(const struct trimesh *mesh);

#ifdef __cplusplus
}
#endif
#endif
