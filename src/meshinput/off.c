/* OFF (Geomview): counts, then a line for each vertex and each face. What follows in a line (normals, colours) is ignored. */
#include <ctype.h>
#include <string.h>

#include "meshinput/read.h"

static bool at_end_or_comment(struct cursor *r)
{
    return cursor_at_line_end(r) || *r->at == '#';
}

/* Skips blank lines and comments up to the next token. */
static status find_token(struct cursor *r, const char *what)
{
    while (r->at < r->end && at_end_or_comment(r))
        cursor_next_line(r);
    return r->at < r->end ? OK : cursor_fail(r, "the file ends before %s", what);
}

/* "OFF", with a prefix of letters that name what else a vertex line has, and the counts, which may follow in the same line. */
static status read_header(struct cursor *r, int64_t counts[2])
{
    status st = OK;
    TRY(find_token(r, "the word OFF"));
    const char *word = r->at;
    while (r->at < r->end && isalnum((unsigned char)*r->at) && strncmp(r->at, "OFF", 3) != 0)
        r->at++;
    if (strncmp(r->at, "OFF", 3) != 0)
        return cursor_fail(r, "not an OFF file: it does not begin with OFF");
    if (memchr(word, '4', (size_t)(r->at - word)) || memchr(word, 'n', (size_t)(r->at - word)))
        return cursor_fail(
            r,
            "%.*sOFF is not supported: its vertices have more than three coordinates or normals: convert it to PLY or STL",
            (int)(r->at - word), word);
    r->at += 3;
    TRY(find_token(r, "the number of vertices"));
    if (strncmp(r->at, "BINARY", 6) == 0)
        return cursor_fail(r, "binary OFF is not supported: convert it to PLY or STL");
    for (int i = 0; i < 2; i++)
        TRY(cursor_integer(r, &counts[i]));
    if (counts[0] < 0 || counts[1] < 0)
        return cursor_fail(r, "a count is negative");
done:
    return st;
}

static status read_face(struct cursor *r, struct mesh *mesh, int64_t n_vertices)
{
    status st = OK;
    int64_t n, corner;
    uint32_t first = 0, last = 0;
    TRY(cursor_integer(r, &n));
    for (int64_t k = 0; k < n; k++) {
        TRY(cursor_integer(r, &corner));
        if (corner < 0 || corner >= n_vertices)
            return cursor_fail(r, "a face refers to vertex %lld, but the file has %lld, counted from 0",
                               (long long)corner, (long long)n_vertices);
        if (k == 0)
            first = (uint32_t)corner;
        if (k >= 2)
            TRY(mesh_add_triangle(mesh, first, last, (uint32_t)corner));
        last = (uint32_t)corner;
    }
done:
    return st;
}

status off_read(struct cursor *r, struct mesh *mesh)
{
    status st = OK;
    int64_t counts[2];
    TRY(read_header(r, counts));
    cursor_next_line(r);
    for (int64_t i = 0; i < counts[0]; i++) {
        double x[3];
        TRY(find_token(r, "its last vertex"));
        for (int a = 0; a < 3; a++)
            TRY(cursor_number(r, &x[a]));
        TRY(mesh_add_vertex(mesh, x));
        cursor_next_line(r);
    }
    for (int64_t i = 0; i < counts[1]; i++) {
        TRY(find_token(r, "its last face"));
        TRY(read_face(r, mesh, counts[0]));
        cursor_next_line(r);
    }
done:
    return st;
}
