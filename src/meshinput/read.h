/* Shared by the readers of mesh formats: a cursor in the file's bytes that counts lines, and a mesh that grows. */
#ifndef HOODOO_MESHINPUT_READ_H
#define HOODOO_MESHINPUT_READ_H

#include <stdbool.h>

#include "meshinput/mesh.h"

struct cursor {
    const char *path, *begin, *at, *end; /* *end is NUL */
    size_t line;
};

/* Fails with E_INPUT and the message "PATH:LINE: ...". */
status cursor_fail(const struct cursor *r, const char *format, ...) PRINTF_LIKE(2, 3);

/* Skips blanks and backslash-newlines; true at the end of the line or file. */
bool cursor_at_line_end(struct cursor *r);
void cursor_next_line(struct cursor *r);

/* Parse the next number on this line. E_INPUT: there is none, or its magnitude exceeds 1e30. */
MUST_USE status cursor_number(struct cursor *r, double *out);
MUST_USE status cursor_integer(struct cursor *r, int64_t *out);

/* E_MEMORY; E_INPUT: more than 2^32 - 1 vertices. */
MUST_USE status mesh_add_vertex(struct mesh *mesh, const double x[3]);
MUST_USE status mesh_add_triangle(struct mesh *mesh, uint32_t a, uint32_t b, uint32_t c);

/* The file's format by its content, or by its name if the content does not tell. E_INPUT: a known format that is not supported. */
enum mesh_format { MESH_OBJ, MESH_PLY, MESH_STL, MESH_OFF, MESH_GLTF, MESH_GLB };
MUST_USE status mesh_format_of(const char *path, enum mesh_format *format);

/* Has `program` (hoodoo-read-mesh, hoodoo-read) decode the mesh; reader/mesh_part.h has the kinds and their arguments `word`, which end
 * with NULL. Checks the answer. Free *mesh with mesh_free(). Errors of reader_ask(). */
struct mesh_part;
MUST_USE status mesh_read_by(const char *program, const char *kind, const char *path, const char *const *word,
                             struct mesh_part *part, struct mesh *mesh);

/* Append the file's vertices and triangles. E_INPUT: damaged. E_MEMORY. */
MUST_USE status obj_read(struct cursor *r, struct mesh *mesh);
MUST_USE status stl_read(struct cursor *r, struct mesh *mesh);
MUST_USE status off_read(struct cursor *r, struct mesh *mesh);
MUST_USE status ply_read(struct cursor *r, struct mesh *mesh);

#endif
