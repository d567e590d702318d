/* What the OBJ and PLY readers share: a cursor in the file's bytes that knows its line, and a mesh that
 * grows. */
#ifndef HOODOO_MESHINPUT_READ_H
#define HOODOO_MESHINPUT_READ_H

#include <stdbool.h>

#include "meshinput/mesh.h"

struct reader {
    const char *path, *begin, *at, *end; /* *end is a NUL */
    size_t line;
};

/* "PATH:LINE: " and the sentence; E_INPUT. */
status reader_fail(const struct reader *r, const char *format, ...) PRINTF_LIKE(2, 3);

/* Steps over blanks and backslash-newlines; true at the end of the line or file. */
bool reader_at_line_end(struct reader *r);
void reader_next_line(struct reader *r);

/* Numbers on this line. E_INPUT: something else stands there, or the number is not finite or too large. */
MUST_USE status reader_number(struct reader *r, double *out);
MUST_USE status reader_integer(struct reader *r, int64_t *out);

MUST_USE status mesh_add_vertex(struct mesh *mesh, const double x[3]);
MUST_USE status mesh_add_triangle(struct mesh *mesh, uint32_t a, uint32_t b, uint32_t c);

/* What the file is, by its content, or where that says nothing by its name. E_INPUT: a kind that nobody here reads. */
enum mesh_format { MESH_OBJ, MESH_PLY, MESH_STL, MESH_OFF, MESH_GLTF, MESH_GLB };
MUST_USE status mesh_kind(const char *path, enum mesh_format *format);

/* A mesh by a program of its own (reader/mesh_part.h). */
struct mesh_part;
MUST_USE status mesh_ask(const char *program, const char *kind, const char *path, const char *const *word,
                         struct mesh_part *part, struct mesh *mesh);

MUST_USE status obj_read(struct reader *r, struct mesh *mesh);
MUST_USE status stl_read(struct reader *r, struct mesh *mesh);
MUST_USE status off_read(struct reader *r, struct mesh *mesh);
MUST_USE status ply_read(struct reader *r, struct mesh *mesh);

#endif
