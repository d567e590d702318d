/* OFF (Geomview): counts, then a line for each vertex and each face. In a file that begins with COFF or NCOFF, vertices have colours. What
 * else follows in a line is ignored. */
#include <ctype.h>
#include <string.h>

#include "meshinput/decode.h"

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

/* What a vertex line has besides its position. */
struct layout {
    bool normals, colors;
};

/* "OFF", with a prefix of letters that name what else a vertex line has, and the counts, which may follow in the same line. */
static status read_header(struct cursor *r, int64_t counts[2], struct layout *out)
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
    out->normals = memchr(word, 'N', (size_t)(r->at - word)) != NULL;
    out->colors = memchr(word, 'C', (size_t)(r->at - word)) != NULL;
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

/* A component of a colour: an integer of 0 to 255, or a number with a decimal point. */
static status read_component(struct cursor *r, double *out)
{
    status st = OK;
    cursor_at_line_end(r);
    const char *begin = r->at;
    TRY(cursor_number(r, out));
    if (!memchr(begin, '.', (size_t)(r->at - begin)))
        *out /= 255;
done:
    return st;
}

static status read_vertex(struct cursor *r, const struct layout *has, struct mesh *mesh)
{
    static const char *const names[] = {"red", "green", "blue", "alpha"};
    status st = OK;
    double x[3], value;
    for (int a = 0; a < 3; a++)
        TRY(cursor_number(r, &x[a]));
    TRY(mesh_add_vertex(mesh, x));
    for (int a = 0; a < 3 && has->normals; a++)
        TRY(cursor_number(r, &value));
    for (int i = 0; i < 4 && has->colors && (i < 3 || !at_end_or_comment(r)); i++) {
        TRY(read_component(r, &value));
        if (attribute_is(r->attribute, names[i]))
            TRY(mesh_add_value(mesh, value));
    }
done:
    return st;
}

static status read_face(struct cursor *r, struct mesh *mesh, int64_t n_vertices, struct polygon *face)
{
    status st = OK;
    int64_t n, corner;
    face->n = 0;
    TRY(cursor_integer(r, &n));
    for (int64_t k = 0; k < n; k++) {
        TRY(cursor_integer(r, &corner));
        if (corner < 0 || corner >= n_vertices)
            return cursor_fail(r, "a face refers to vertex %lld, but the file has %lld, counted from 0",
                               (long long)corner, (long long)n_vertices);
        TRY(polygon_add(face, (uint32_t)corner));
    }
    TRY(mesh_add_polygon(mesh, face));
done:
    return st;
}

status off_read(struct cursor *r, struct mesh *mesh)
{
    status st = OK;
    int64_t counts[2];
    struct layout has = {0};
    struct polygon face = {0};
    TRY(read_header(r, counts, &has));
    cursor_next_line(r);
    for (int64_t i = 0; i < counts[0]; i++) {
        TRY(find_token(r, "its last vertex"));
        TRY(read_vertex(r, &has, mesh));
        cursor_next_line(r);
    }
    for (int64_t i = 0; i < counts[1]; i++) {
        TRY(find_token(r, "its last face"));
        TRY(read_face(r, mesh, counts[0], &face));
        cursor_next_line(r);
    }
done:
    polygon_free(&face);
    return st;
}
