/* Triangle meshes as files: PLY with everything that a vertex has, OBJ with position, normal and colour. */
#ifndef HOODOO_MESH_FILE_H
#define HOODOO_MESH_FILE_H

#include <stddef.h>
#include <stdint.h>

#include "text/text.h"

struct mesh_file {
    const char *name;    /* of the object */
    const char *comment; /* one line */
    int up;              /* OUTPUT_UP_*: the file's axes */
    size_t n_vertices, n_triangles;
    const float *vertex, *normal; /* [n_vertices][3], in the simulator's axes; m */
    const uint32_t *triangle;     /* [n_triangles][3] */
    size_t n_values;
    const char *const *value_name; /* [n_values] */
    const float *value;            /* [n_values][n_vertices] */
    const float *velocity;         /* [3][n_vertices] m/s, in the simulator's axes; NULL if nothing moves */
    const uint32_t *layer;         /* [n_vertices] */
    const float (*color)[3];       /* [n_vertices], linear Rec. 709 */
};

/* Binary little-endian PLY. Per vertex: x y z nx ny nz, vx vy vz if rock moves, and the values, all float; int layer; uchar red green
 * blue in sRGB, as other programs expect. */
void mesh_file_ply(const struct mesh_file *file, struct text *out);

/* OBJ with `v x y z r g b`, in sRGB. Positions have enough digits to be read back as the same floats, so that no triangles cross. */
void mesh_file_obj(const struct mesh_file *file, struct text *out);

#endif
