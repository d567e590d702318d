/* Wavefront OBJ: vertices, with the colours that many programs append to them, and faces; everything else (normals, texture coordinates,
 * groups, lines) is ignored. */
#include <stdlib.h>

#include "meshinput/decode.h"

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

static status read_face(struct cursor *r, struct mesh *mesh, struct polygon *face)
{
    status st = OK;
    uint32_t corner = 0;
    face->n = 0;
    while (!cursor_at_line_end(r) && *r->at != '#') {
        TRY(read_corner(r, mesh, &corner));
        TRY(polygon_add(face, corner));
    }
    if (face->n < 3)
        return cursor_fail(r, "a face has %zu corners, but it needs at least 3", face->n);
    TRY(mesh_add_polygon(mesh, face));
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

/* "x y z", "x y z w", "x y z red green blue" or "x y z red green blue alpha". */
static status read_vertex(struct cursor *r, struct mesh *mesh)
{
    static const char *const names[] = {"red", "green", "blue", "alpha"};
    status st = OK;
    double x[3], more[4];
    size_t n = 0;
    for (int a = 0; a < 3; a++)
        TRY(cursor_number(r, &x[a]));
    TRY(mesh_add_vertex(mesh, x));
    for (; n < 4 && !cursor_at_line_end(r) && *r->at != '#'; n++)
        TRY(cursor_number(r, &more[n]));
    for (size_t i = 0; n >= 3 && i < n; i++)
        if (attribute_is(r->attribute, names[i]))
            TRY(mesh_add_value(mesh, more[i]));
done:
    return st;
}

status obj_read(struct cursor *r, struct mesh *mesh)
{
    status st = OK;
    struct polygon face = {0};
    for (; r->at < r->end; cursor_next_line(r)) {
        if (cursor_at_line_end(r))
            continue;
        if (line_is(r, 'v')) {
            TRY(read_vertex(r, mesh));
        } else if (line_is(r, 'f')) {
            TRY(read_face(r, mesh, &face));
        }
    }
done:
    polygon_free(&face);
    return st;
}
