#include "meshinput/mesh.h"

#include <errno.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/atomic_file.h"
#include "base/memory.h"
#include "meshinput/read.h"
#include "reader/mesh_part.h"

#define MESH_FILE_LIMIT ((size_t)8 << 30)

status cursor_fail(const struct cursor *r, const char *format, ...)
{
    char text[512];
    va_list args;
    va_start(args, format);
    vsnprintf(text, sizeof text, format, args);
    va_end(args);
    return fail(E_INPUT, "%s:%zu: %s", r->path, r->line, text);
}

bool cursor_at_line_end(struct cursor *r)
{
    for (; r->at < r->end; r->at++) {
        if (*r->at == '\n')
            return true;
        if (*r->at == '\\' && r->at + 1 < r->end && r->at[1] == '\n') {
            r->at++;
            r->line++;
        } else if (*r->at == '\\' && r->end - r->at > 2 && r->at[1] == '\r' && r->at[2] == '\n') {
            r->at += 2;
            r->line++;
        } else if (*r->at != ' ' && *r->at != '\t' && *r->at != '\r') {
            return false;
        }
    }
    return true;
}

void cursor_next_line(struct cursor *r)
{
    const char *newline = memchr(r->at, '\n', (size_t)(r->end - r->at));
    r->at = newline ? newline + 1 : r->end;
    r->line += newline != NULL;
}

/* The token at the cursor, shortened for a message. */
static const char *token(const struct cursor *r, char out[24])
{
    size_t n = 0;
    while (n < 20 && r->at + n < r->end && r->at[n] > ' ')
        n++;
    memcpy(out, r->at, n);
    strcpy(out + n, n == 20 ? "..." : "");
    return n ? out : "nothing";
}

status cursor_number(struct cursor *r, double *out)
{
    char text[24], *stop;
    if (cursor_at_line_end(r))
        return cursor_fail(r, "a number is missing at the end of the line");
    double value = strtod(r->at, &stop); /* the bytes end in a NUL */
    if (stop == r->at)
        return cursor_fail(r, "expected a number, found '%s'", token(r, text));
    if (!(fabs(value) <= 1e30))
        return cursor_fail(r, "'%s' is not finite or larger than 1e30", token(r, text));
    r->at = stop;
    *out = value;
    return OK;
}

status cursor_integer(struct cursor *r, int64_t *out)
{
    char text[24], *stop;
    if (cursor_at_line_end(r))
        return cursor_fail(r, "an integer is missing at the end of the line");
    errno = 0;
    long long value = strtoll(r->at, &stop, 10);
    if (stop == r->at || errno != 0)
        return cursor_fail(r, "expected an integer, found '%s'", token(r, text));
    r->at = stop;
    *out = value;
    return OK;
}

status mesh_add_vertex(struct mesh *mesh, const double x[3])
{
    status st = OK;
    if (mesh->n_vertices >= UINT32_MAX)
        return fail(E_INPUT, "the mesh has more than %u vertices", UINT32_MAX);
    TRY(memory_grow(&mesh->vertex, &mesh->vertex_capacity, mesh->n_vertices + 1, sizeof *mesh->vertex,
                    "a mesh"));
    memcpy(mesh->vertex[mesh->n_vertices++], x, sizeof *mesh->vertex);
done:
    return st;
}

status mesh_add_triangle(struct mesh *mesh, uint32_t a, uint32_t b, uint32_t c)
{
    status st = OK;
    const uint32_t corners[3] = {a, b, c};
    TRY(memory_grow(&mesh->triangle, &mesh->triangle_capacity, mesh->n_triangles + 1, sizeof *mesh->triangle,
                    "a mesh"));
    memcpy(mesh->triangle[mesh->n_triangles++], corners, sizeof corners);
done:
    return st;
}

status mesh_read(const char *path, struct mesh *mesh)
{
    static status (*const read[])(struct cursor *, struct mesh *) = {
        [MESH_OBJ] = obj_read, [MESH_PLY] = ply_read, [MESH_STL] = stl_read, [MESH_OFF] = off_read};
    status st = OK;
    char *bytes = NULL;
    size_t size = 0;
    enum mesh_format format;
    struct mesh_part part;
    *mesh = (struct mesh){0};
    TRY(mesh_format_of(path, &format));
    if (format == MESH_GLTF || format == MESH_GLB) {
        const char *const word[] = {format == MESH_GLB ? "glb" : "gltf", NULL};
        TRY(mesh_read_by("hoodoo-read-mesh", "mesh", path, word, &part, mesh));
        mesh->y_up = true;
    } else {
        TRY(file_read(path, MESH_FILE_LIMIT, &bytes, &size));
        struct cursor r = {.path = path, .begin = bytes, .at = bytes, .end = bytes + size, .line = 1};
        TRY(read[format](&r, mesh));
    }
    if (mesh->n_triangles == 0)
        st = fail(E_INPUT,
                  "%s: it has no faces: it is not an OBJ, PLY, STL, glTF, GLB or OFF mesh, or an empty one",
                  path);
done:
    free(bytes);
    if (st != OK)
        mesh_free(mesh);
    return st;
}

void mesh_free(struct mesh *mesh)
{
    free(mesh->vertex);
    free(mesh->triangle);
    *mesh = (struct mesh){0};
}
