/* Triangle meshes as files: PLY with everything a vertex carries, OBJ with its place, normal and colour. */
#ifndef HOODOO_MESH_FILE_H
#define HOODOO_MESH_FILE_H

#include <stddef.h>
#include <stdint.h>

#include "base/text.h"

struct mesh_file {
    const char *name;    /* of the object */
    const char *comment; /* one line */
    int up;              /* OUTPUT_UP_*: the file's axes */
    size_t n_vertices, n_triangles;
    const float *vertex, *normal; /* [n_vertices][3], in the simulator's axes */
    const uint32_t *triangle;     /* [n_triangles][3] */
    size_t n_values;
    const char *const *value_name; /* [n_values] */
    const float *value;            /* [n_values][n_vertices] */
    const float *velocity;         /* [3][n_vertices] m/s, in the simulator's axes; NULL: it does not move */
    const uint32_t *layer;         /* [n_vertices] */
    const float (*color)[3];       /* [n_vertices], linear Rec. 709 */
};

/* PLY, binary, little endian: x y z nx ny nz, vx vy vz of what moves, the values, all float; int layer; uchar red green blue, sRGB as
 * readers take them. */
void mesh_file_ply(const struct mesh_file *file, struct text *out);

/* OBJ: `v x y z r g b`, sRGB. Positions read back as the same floats, so that nothing crosses. */
void mesh_file_obj(const struct mesh_file *file, struct text *out);

#endif
