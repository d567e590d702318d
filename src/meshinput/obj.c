/* Wavefront OBJ: vertices and faces; everything else (normals, texture coordinates, groups, lines) is ignored. */
#include <stdlib.h>

#include "meshinput/read.h"

/* The vertex index of a face's corner: 1 is the first vertex of the file, -1 the last so far. "/texture/normal" after it must be
 * well-formed but is ignored. */
static status read_corner(struct cursor *r, const struct mesh *mesh, uint32_t *out)
{
    status st = OK;
    int64_t index, other;
    TRY(cursor_integer(r, &index));
    int64_t n = (int64_t)mesh->n_vertices;
    if (index == 0 || index > n || index < -n)
        return cursor_fail(r, "a face refers to vertex %lld, but only %lld are defined above it",
                           (long long)index, (long long)n);
    *out = (uint32_t)(index > 0 ? index - 1 : n + index);
    for (int part = 0; part < 2 && *r->at == '/'; part++) {
        r->at++;
        if (*r->at == '-' || (*r->at >= '0' && *r->at <= '9'))
            TRY(cursor_integer(r, &other));
    }
    if (*r->at == '/' || (*r->at > ' ' && *r->at != '\\'))
        st = cursor_fail(r, "a face's corner must have the form 1, 1/2, 1//3 or 1/2/3");
done:
    return st;
}

static status read_face(struct cursor *r, struct mesh *mesh)
{
    status st = OK;
    uint32_t first = 0, last = 0, corner = 0;
    size_t n = 0;
    for (; !cursor_at_line_end(r) && *r->at != '#'; n++) {
        TRY(read_corner(r, mesh, &corner));
        if (n == 0)
            first = corner;
        if (n >= 2)
            TRY(mesh_add_triangle(mesh, first, last, corner));
        last = corner;
    }
    if (n < 3)
        st = cursor_fail(r, "a face has %zu corners, but it needs at least 3", n);
done:
    return st;
}

/* Skips the keyword `key` if the line starts with it. */
static bool line_is(struct cursor *r, char key)
{
    if (r->end - r->at < 2 || r->at[0] != key || (r->at[1] != ' ' && r->at[1] != '\t'))
        return false;
    r->at++;
    return true;
}

status obj_read(struct cursor *r, struct mesh *mesh)
{
    status st = OK;
    double x[3];
    for (; r->at < r->end; cursor_next_line(r)) {
        if (cursor_at_line_end(r))
            continue;
        if (line_is(r, 'v')) {
            for (int a = 0; a < 3; a++)
                TRY(cursor_number(r, &x[a]));
            TRY(mesh_add_vertex(mesh, x));
        } else if (line_is(r, 'f')) {
            TRY(read_face(r, mesh));
        }
    }
done:
    return st;
}
