/* The decoders of mesh formats, which run in hoodoo-read-mesh: a cursor in the file's bytes that counts lines, and one function for each
 * format. Debian's assimp stores coordinates as 32-bit floats: enough for glTF, whose coordinates are floats, but not for the map
 * coordinates that the other formats may have, which are therefore parsed here. */
#ifndef HOODOO_MESHINPUT_DECODE_H
#define HOODOO_MESHINPUT_DECODE_H

#include <stdbool.h>

#include "meshinput/mesh.h"

#ifdef __cplusplus
extern "C" {
#endif

/* The attribute of vertices to read, and those that the file has. */
struct attribute {
    const char *name; /* "": none is read */
    bool found;
    char there[600]; /* "'red', 'green'", shortened */
};

/* Notes that the file has the attribute `name`. True if it is the one to read. */
bool attribute_is(struct attribute *attribute, const char *name);

/* The corners of a face. */
struct polygon {
    uint32_t *corner;
    size_t n, capacity;
};
MUST_USE status polygon_add(struct polygon *polygon, uint32_t corner);
void polygon_free(struct polygon *polygon);

/* Adds the polygon as n - 2 triangles: as a fan if that covers it, else by cutting off its ears (Meisters 1975), so that triangles of a
 * concave face do not reach out of it. Nothing for fewer than 3 corners. E_MEMORY. */
MUST_USE status mesh_add_polygon(struct mesh *mesh, const struct polygon *polygon);

struct cursor {
    const char *path, *begin, *at, *end; /* *end is NUL */
    size_t line;
    struct attribute *attribute;
};

/* Fails with E_INPUT and the message "PATH:LINE: ...". */
status cursor_fail(const struct cursor *r, const char *format, ...) PRINTF_LIKE(2, 3);

/* Skips blanks and backslash-newlines; true at the end of the line or file. */
bool cursor_at_line_end(struct cursor *r);
void cursor_next_line(struct cursor *r);

/* Parse the next number on this line. E_INPUT: there is none, or its magnitude exceeds 1e30. */
MUST_USE status cursor_number(struct cursor *r, double *out);
MUST_USE status cursor_integer(struct cursor *r, int64_t *out);

/* Append the file's vertices, with the values of the attribute, and its triangles. E_INPUT: damaged. E_MEMORY. */
MUST_USE status obj_read(struct cursor *r, struct mesh *mesh);
MUST_USE status stl_read(struct cursor *r, struct mesh *mesh);
MUST_USE status off_read(struct cursor *r, struct mesh *mesh);
MUST_USE status ply_read(struct cursor *r, struct mesh *mesh);

/* A buffer of a glTF file that is in another file. */
struct mesh_buffer {
    const char *uri, *bytes;
    size_t n;
};

/* The bytes of a file; a NUL follows them. */
struct mesh_file {
    const char *path, *bytes;
    size_t n;
    const struct mesh_buffer *buffer;
    size_t n_buffers;
};

/* Decodes glTF; `is_binary`: GLB. E_INPUT: damaged. E_MEMORY. */
typedef status gltf_function(const struct mesh_file *file, bool is_binary, struct attribute *attribute,
                             struct mesh *mesh);
gltf_function gltf_import; /* with assimp, in hoodoo-read-mesh only */

/* Recognises the format and decodes the file. `attribute`: "" for none. `gltf`: gltf_import(), or NULL to refuse glTF. Free *mesh with
 * mesh_free(). E_INPUT, E_MEMORY: as mesh_read(). */
MUST_USE status mesh_decode(const struct mesh_file *file, const char *attribute, gltf_function *gltf,
                            struct mesh *mesh);

#ifdef __cplusplus
}
#endif
#endif
