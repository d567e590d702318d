/* The edges of a mesh; from them, whether it is closed and whether its faces are oriented consistently. */
#ifndef HOODOO_MESHINPUT_EDGES_H
#define HOODOO_MESHINPUT_EDGES_H

#include "meshinput/mesh.h"

/* A half-edge: one side of one triangle. The half-edges whose lower vertex is v are side[begin[v] .. begin[v + 1]), sorted by their other
 * vertex `to`, then by triangle. */
struct mesh_side {
    uint32_t to, triangle;
    int direction; /* 1: the triangle runs from the lower vertex to the higher, -1: back */
};

struct mesh_edges {
    size_t n_vertices;
    size_t *begin;
    struct mesh_side *side;
};

/* Free *out with mesh_edges_free(). E_MEMORY. */
MUST_USE status mesh_edges_create(const struct mesh *mesh, struct mesh_edges *out);
void mesh_edges_free(struct mesh_edges *edges);

/* The end of the run of half-edges from `first` on that belong to one edge; v is its lower vertex. *directions is the sum of their
 * directions: 0 if the edge is closed. */
size_t mesh_edge_end(const struct mesh_edges *edges, size_t v, size_t first, int *directions);

/* Open edges, at which the surface ends: those whose directions do not add up to 0. */
struct mesh_open {
    size_t n;
    uint32_t (*edge)[2]; /* freed with free() */
};
/* The caller frees out->edge. E_MEMORY. */
MUST_USE status mesh_find_open(const struct mesh *mesh, struct mesh_open *out);

/* Joins vertices of open edges that are at most `tolerance` apart, m, and drops triangles that then have fewer than three corners.
 * E_MEMORY. */
struct mesh_welded {
    size_t n;        /* vertices that were joined to another one */
    double farthest; /* m, the largest distance between two that were joined */
};
MUST_USE status mesh_weld_open(struct mesh *mesh, const struct mesh_open *open, double tolerance,
                               struct mesh_welded *out);

/* Flips faces so that neighbours are oriented alike: of each edge-connected patch, the orientation with the smaller area. *flipped: the
 * number of faces. E_MEMORY. */
MUST_USE status mesh_orient_consistently(struct mesh *mesh, size_t *flipped);

/* Flips parts (connected components) that are inside out: first the whole mesh if its volume is negative, then each closed part of
 * negative volume that is not a cavity in other parts. `open`: the mesh's open edges. *flipped: the number of parts. E_MEMORY. */
MUST_USE status mesh_orient_outwards(struct mesh *mesh, const struct mesh_open *open, size_t *flipped);

/* Keeps one of the triangles that have the same three corners. *dropped: the number of the others. E_MEMORY. */
MUST_USE status mesh_drop_duplicates(struct mesh *mesh, size_t *dropped);

/* The volume of a closed mesh, m3: positive if its faces are counter-clockwise from outside. */
double mesh_volume(const struct mesh *mesh);

/* The normal's length is the area, m2; it points outwards if the face is counter-clockwise from outside. */
void mesh_triangle_normal(const struct mesh *mesh, size_t triangle, double normal[3]);
double mesh_triangle_area(const struct mesh *mesh, size_t triangle);

#endif
