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

/* Has hoodoo-read decode the surface of an OpenVDB grid: the kind "vdb.shape", whose arguments end with NULL (reader/mesh_part.h). */
MUST_USE status mesh_read_volume(const char *path, const char *const *argument, struct mesh_part *part,
                                 struct mesh *mesh);

/* Takes and checks the answer of either. `has_value`: an attribute was asked for. E_INPUT: it is malformed. E_MEMORY. */
MUST_USE status mesh_take(struct reader_answer *answer, bool has_value, struct mesh_part *part,
                          struct mesh *mesh);

#endif
