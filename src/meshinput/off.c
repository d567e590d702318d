/* OFF (Geomview): counts, corners, then faces, a line each. What stands behind a corner's place or a face's corners in its line
 * (normals, colours) is passed over. */
#include <ctype.h>
#include <string.h>

#include "meshinput/read.h"

static bool at_end_or_comment(struct reader *r)
{
    return reader_at_line_end(r) || *r->at == '#';
}

/* Goes on to where something stands. */
static status find_something(struct reader *r, const char *what)
{
    while (r->at < r->end && at_end_or_comment(r))
        reader_next_line(r);
    return r->at < r->end ? OK : reader_fail(r, "the file ends where %s should stand", what);
}

/* OFF, with letters before it that say what more a corner's line has. Counts may follow at once. */
static status read_head(struct reader *r, int64_t counts[2])
{
    status st = OK;
    TRY(find_something(r, "OFF"));
    const char *word = r->at;
    while (r->at < r->end && isalnum((unsigned char)*r->at) && strncmp(r->at, "OFF", 3) != 0)
        r->at++;
    if (strncmp(r->at, "OFF", 3) != 0)
        return reader_fail(r, "no OFF file: it does not begin with OFF");
    if (memchr(word, '4', (size_t)(r->at - word)) || memchr(word, 'n', (size_t)(r->at - word)))
        return reader_fail(r, "corners of more than three numbers: %.*sOFF is not read", (int)(r->at - word),
                           word);
    r->at += 3;
    TRY(find_something(r, "the number of corners"));
    if (strncmp(r->at, "BINARY", 6) == 0)
        return reader_fail(r, "binary OFF is not read: convert it to PLY or STL");
    for (int i = 0; i < 2; i++)
        TRY(reader_integer(r, &counts[i]));
    if (counts[0] < 0 || counts[1] < 0)
        return reader_fail(r, "a count below 0");
done:
    return st;
}

static status read_face(struct reader *r, struct mesh *mesh, int64_t n_vertices)
{
    status st = OK;
    int64_t n, corner;
    uint32_t first = 0, last = 0;
    TRY(reader_integer(r, &n));
    for (int64_t k = 0; k < n; k++) {
        TRY(reader_integer(r, &corner));
        if (corner < 0 || corner >= n_vertices)
            return reader_fail(r, "a face uses corner %lld, but there are %lld, from 0", (long long)corner,
                               (long long)n_vertices);
        if (k == 0)
            first = (uint32_t)corner;
        if (k >= 2)
            TRY(mesh_add_triangle(mesh, first, last, (uint32_t)corner));
        last = (uint32_t)corner;
    }
done:
    return st;
}

status off_read(struct reader *r, struct mesh *mesh)
{
    status st = OK;
    int64_t counts[2];
    TRY(read_head(r, counts));
    reader_next_line(r);
    for (int64_t i = 0; i < counts[0]; i++) {
        double x[3];
        TRY(find_something(r, "a corner"));
        for (int a = 0; a < 3; a++)
            TRY(reader_number(r, &x[a]));
        TRY(mesh_add_vertex(mesh, x));
        reader_next_line(r);
    }
    for (int64_t i = 0; i < counts[1]; i++) {
        TRY(find_something(r, "a face"));
        TRY(read_face(r, mesh, counts[0]));
        reader_next_line(r);
    }
done:
    return st;
}
