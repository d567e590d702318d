/* Wavefront OBJ: its vertices and faces; everything else in it (normals, texture, groups, lines) is passed
 * over. */
#include <stdlib.h>

#include "meshinput/read.h"

/* Index of a face's corner: 1 is the first vertex so far, -1 the last. "/texture/normal" behind it are
 * checked for form. */
static status read_corner(struct reader *r, const struct mesh *mesh, uint32_t *out)
{
    status st = OK;
    int64_t index, other;
    TRY(reader_integer(r, &index));
    int64_t n = (int64_t)mesh->n_vertices;
    if (index == 0 || index > n || index < -n)
        return reader_fail(r, "a face uses vertex %lld, but %lld stand above it", (long long)index,
                           (long long)n);
    *out = (uint32_t)(index > 0 ? index - 1 : n + index);
    for (int part = 0; part < 2 && *r->at == '/'; part++) {
        r->at++;
        if (*r->at == '-' || (*r->at >= '0' && *r->at <= '9'))
            TRY(reader_integer(r, &other));
    }
    if (*r->at == '/' || (*r->at > ' ' && *r->at != '\\'))
        st = reader_fail(r, "a face's corner should look like 1, 1/2, 1//3 or 1/2/3");
done:
    return st;
}

static status read_face(struct reader *r, struct mesh *mesh)
{
    status st = OK;
    uint32_t first = 0, last = 0, corner = 0;
    size_t n = 0;
    for (; !reader_at_line_end(r) && *r->at != '#'; n++) {
        TRY(read_corner(r, mesh, &corner));
        if (n == 0)
            first = corner;
        if (n >= 2)
            TRY(mesh_add_triangle(mesh, first, last, corner));
        last = corner;
    }
    if (n < 3)
        st = reader_fail(r, "a face of %zu corners: it needs 3", n);
done:
    return st;
}

/* Does the line start with the one letter `key`? Then steps over it. */
static bool line_is(struct reader *r, char key)
{
    if (r->end - r->at < 2 || r->at[0] != key || (r->at[1] != ' ' && r->at[1] != '\t'))
        return false;
    r->at++;
    return true;
}

status obj_read(struct reader *r, struct mesh *mesh)
{
    status st = OK;
    double x[3];
    for (; r->at < r->end; reader_next_line(r)) {
        if (reader_at_line_end(r))
            continue;
        if (line_is(r, 'v')) {
            for (int a = 0; a < 3; a++)
                TRY(reader_number(r, &x[a]));
            TRY(mesh_add_vertex(mesh, x));
        } else if (line_is(r, 'f')) {
            TRY(read_face(r, mesh));
        }
    }
done:
    return st;
}
