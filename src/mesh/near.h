/* Triangles by where they are: those whose boxes overlap a box. */
#ifndef HOODOO_MESH_NEAR_H
#define HOODOO_MESH_NEAR_H

#include <stdbool.h>

#include "mesh/trimesh.h"

struct near {
    const struct trimesh *mesh; /* may change; near_add() again what moved */
    double low[3], cell;
    int n[3];
    struct near_list {
        uint32_t *triangle;
        size_t n, capacity;
    } * list;         /* [cells] */
    int16_t (*in)[6]; /* [n_triangles] the cells each is listed in: lowest, highest */
    float (*box)[6];  /* [n_triangles] lowest, highest corner; empty if it is gone */
};

/* All triangles, in cells of `cell` or larger. */
MUST_USE status near_create(struct near *near, const struct trimesh *mesh, double cell);
void near_destroy(struct near *near);

/* The triangle is new or has moved; it must lie in the box of those of the start. */
MUST_USE status near_add(struct near *near, uint32_t triangle);
void near_remove(struct near *near, uint32_t triangle);

struct near_found {
    uint32_t *triangle;
    size_t n, capacity;
};
/* Those whose boxes overlap the box; one may be found twice. found->triangle is the caller's to free. */
MUST_USE status near_find(const struct near *near, const float box[6], struct near_found *found);

/* Corners of a triangle as doubles, and its box. */
void near_corners(const struct trimesh *mesh, const uint32_t corner[3], double out[3][3]);
void near_box(const struct trimesh *mesh, const uint32_t corner[3], float out[6]);

/* Do two triangles, given by their corners, meet only in what they share? Certain if true. */
bool near_apart(const struct trimesh *mesh, const uint32_t a[3], const uint32_t b[3]);

#endif
