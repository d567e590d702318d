/* Surfaces as triangles: closed, manifold, wound outwards and free of crossings by construction.
 *
 * March      Lorensen and Cline's marching cubes (1987) on samples without ambiguous faces. Where a face of a
 *            cell has its two inside corners on a diagonal, one of its outside corners is made inside, the
 *            one nearest to the surface, until no such face is left: diagonal neighbours are joined. What is
 *            left are the cases in which every polygon, seen along the direction from its inside to its
 *            outside corners, is convex with its corners on the outline of the cell. However it is cut into
 *            triangles, none cross, none lie in a face of the cell, and cells meet only in the segments on
 *            their faces. Vertices keep a small share of an edge away from samples, so no triangle is a
 *            point. Vertices of equal lattice coordinate have equal floats, so rounding changes none of this.
 * Smooth     Taubin's two steps (1995), in and out, along the normals; the volume stays. See trimesh_smooth().
 * Simplify   Vertices are drawn into a neighbour while every vertex of the first surface stays within a
 *            tolerance of the new one.
 *
 * The last two refuse what would make triangles cross: near ones are compared by separating axes (apart.h).
 * The same input gives the same bits on any number of threads.
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

/* A vertex' distance from a sample is at least this share of the edge. */
#define TRIMESH_CLEARANCE (1.0 / 64)

struct trimesh_lattice {
    int n[3]; /* samples, numbered (k ny + j) nx + i */
    double voxel, origin[3];
};

/* The surface between samples below 0 and the others. What is not finite counts as outside, and so do the
 * outermost samples. Changes `field` where faces are ambiguous. E_INPUT: so far from the origin that floats
 * do not tell vertices apart; or 2^32 vertices. */
MUST_USE status trimesh_march(float *field, const struct trimesh_lattice *lattice, struct trimesh *out);
void trimesh_free(struct trimesh *mesh);

/* `passes` of smoothing in which vertices move in and out by at most `reach`. With labels [n_vertices] (or NULL),
 * a vertex with a neighbour of another label moves only with those that have both labels too, along the border;
 * others move with their own label only. Nothing moves with what lies beyond an edge sharper than 20 degrees. */
MUST_USE status trimesh_smooth(struct trimesh *mesh, const uint32_t *label, int passes, double reach);

/* Fewer triangles: every vertex that goes is within `tolerance` of the surface that stays; those that stay do
 * not move, and *kept (freed with free()) says which of the vertices they were. With labels, vertices at a
 * border between labels stay. No new edge is longer than `longest`. */
MUST_USE status trimesh_simplify(struct trimesh *mesh, const uint32_t *label, double tolerance,
                                 double longest, uint32_t **kept);

/* Pairs of triangles that cross or touch otherwise than by a shared vertex or edge: *n of them, 0 for
 * everything above; for what others made. */
MUST_USE status trimesh_crossings(const struct trimesh *mesh, size_t *n);

/* Of unit length, each triangle weighted by its angle there: normal[n_vertices][3]. */
void trimesh_normals(const struct trimesh *mesh, float *normal);

/* The m3 it holds. */
double trimesh_volume(const struct trimesh *mesh);

#ifdef __cplusplus
}
#endif
#endif
