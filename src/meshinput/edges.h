/* The edges of a mesh, and what follows from them: whether it is closed, and which way its faces are turned. */
#ifndef HOODOO_MESHINPUT_EDGES_H
#define HOODOO_MESHINPUT_EDGES_H

#include "meshinput/mesh.h"

/* Each triangle's sides stand with their lower corner: those of corner v are side[begin[v]] up to side[begin[v + 1]], by their other
 * corner, which is all that equal edges differ by. */
struct mesh_side {
    uint32_t to, triangle;
    int turn; /* 1: the triangle goes from the lower corner to the higher, -1: back */
};

struct mesh_edges {
    size_t n_vertices;
    size_t *begin;
    struct mesh_side *side;
};

MUST_USE status mesh_edges_create(const struct mesh *mesh, struct mesh_edges *out);
void mesh_edges_free(struct mesh_edges *edges);

/* The sides from `first` on that are of one edge: the index behind the last. `v` is their lower corner; *turns is the sum of theirs,
 * 0 where an edge is closed. */
size_t mesh_edge_end(const struct mesh_edges *edges, size_t v, size_t first, int *turns);

/* Edges at which the surface ends: as many triangles do not go one way along them as the other. */
struct mesh_open {
    size_t n;
    uint32_t (*edge)[2]; /* freed with free() */
};
MUST_USE status mesh_find_open(const struct mesh *mesh, struct mesh_open *out);

/* Joins vertices of open edges that are at most `tolerance` apart, m, and drops triangles without three corners. */
struct mesh_welded {
    size_t n;        /* vertices that went */
    double farthest; /* m: that one went */
};
MUST_USE status mesh_weld_open(struct mesh *mesh, const struct mesh_open *open, double tolerance,
                               struct mesh_welded *out);

/* Turns faces over that are turned the other way than their neighbours, the smaller part of each patch by its area, and
 * says how many. */
MUST_USE status mesh_turn_alike(struct mesh *mesh, size_t *turned);

/* Turns parts over that are inside out: all of the mesh if what its parts hold adds up to less than nothing, then each part that
 * closed, holds less than nothing and is no cavity in others. Says of how many parts. `open`: its open edges. */
MUST_USE status mesh_turn_outwards(struct mesh *mesh, const struct mesh_open *open, size_t *turned);

/* Leaves one of the triangles that have the same corners, and says how many went. */
MUST_USE status mesh_drop_twins(struct mesh *mesh, size_t *dropped);

/* m3, of a closed mesh: what is counter-clockwise from outside holds more than nothing. */
double mesh_volume(const struct mesh *mesh);

/* As long as its area, m2; outwards if it is counter-clockwise from outside. */
void mesh_triangle_normal(const struct mesh *mesh, size_t triangle, double normal[3]);
double mesh_triangle_area(const struct mesh *mesh, size_t triangle);

#endif
