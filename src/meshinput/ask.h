/* Reads triangle meshes from files, which may be hostile, through the programs that decode them. */
#ifndef HOODOO_MESHINPUT_ASK_H
#define HOODOO_MESHINPUT_ASK_H

#include "meshinput/mesh.h"
#include "reader/mesh_part.h"
#include "reader/reader.h"

/* Has hoodoo-read-mesh read `path`, whose format is recognised by its content (OBJ if the content does not tell), and the buffers that a
 * glTF file has in other files. Polygons become triangle fans. `attribute`: which attribute of the vertices to read as mesh->value;
 * NULL: none. Free *mesh with mesh_free(). E_INPUT: file, line or byte and what is wrong; for other formats, which it is and how to
 * convert it; the attributes that the file has, if not this one. E_MEMORY. */
MUST_USE status mesh_read(const char *path, const char *attribute, struct mesh *mesh);

/* A solid as struct solid_part describes it. */
struct mesh_solid {
    struct solid_part part;
    int32_t (*at)[3]; /* [part.n] */
    float *value;     /* [part.n], finite */
};
void mesh_solid_free(struct mesh_solid *solid);

/* Has hoodoo-read decode an OpenVDB file: the kind "vdb.shape", whose arguments end with NULL (reader/mesh_part.h). The result is a mesh or,
 * if part->is_solid, *solid. Free both. E_INPUT: the file is damaged or hostile, or has no such grid. E_MEMORY. */
MUST_USE status mesh_read_volume(const char *path, const char *const *argument, struct mesh_part *part,
                                 struct mesh *mesh, struct mesh_solid *solid);

/* Take and check the answer of either. `has_value`: an attribute was asked for. E_INPUT: it is malformed. E_MEMORY. */
MUST_USE status mesh_take(struct reader_answer *answer, bool has_value, struct mesh_part *part,
                          struct mesh *mesh);
MUST_USE status mesh_take_volume(struct reader_answer *answer, struct mesh_part *part, struct mesh *mesh,
                                 struct mesh_solid *solid);

#endif
