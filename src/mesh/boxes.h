/* A uniform grid over the triangles of a mesh, to find those whose bounding boxes overlap a box. */
#ifndef HOODOO_MESH_BOXES_H
#define HOODOO_MESH_BOXES_H

#include <stdbool.h>

#include "mesh/trimesh.h"

struct boxes {
    const struct trimesh *mesh; /* may change; call boxes_add() again for triangles that moved */
    double low[3], cell;
    int n[3];
    struct boxes_list {
        uint32_t *triangle;
        size_t n, capacity;
    } * list;         /* [cells] */
    int16_t (*in)[6]; /* [n_triangles] the cells in which each is listed: lowest, highest */
    float (*box)[6];  /* [n_triangles] lowest and highest corner; empty if the triangle was removed */
};

/* Adds all triangles of the mesh, to cells of at least `cell` m. */
MUST_USE status boxes_create(struct boxes *boxes, const struct trimesh *mesh, double cell);
void boxes_destroy(struct boxes *boxes);

/* Adds a triangle that is new or has moved. It must lie within the bounding box of the triangles at creation. */
MUST_USE status boxes_add(struct boxes *boxes, uint32_t triangle);
void boxes_remove(struct boxes *boxes, uint32_t triangle);

struct boxes_found {
    uint32_t *triangle; /* the caller frees it with free() */
    size_t n, capacity;
};
/* The triangles whose bounding boxes overlap `box`; a triangle may be listed twice. */
MUST_USE status boxes_find(const struct boxes *boxes, const float box[6], struct boxes_found *found);

/* The corners of a triangle as doubles, and its bounding box. */
void boxes_corners(const struct trimesh *mesh, const uint32_t corner[3], double out[3][3]);
void boxes_of(const struct trimesh *mesh, const uint32_t corner[3], float out[6]);

/* Whether two triangles, given by their corners, meet only in what they share. True is certain. */
bool boxes_apart(const struct trimesh *mesh, const uint32_t a[3], const uint32_t b[3]);

#endif
