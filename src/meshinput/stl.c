/* STL: triangles that share no vertices, as floats or as text. */
#include <math.h>
#include <string.h>
#include <strings.h>

#include "meshinput/decode.h"

enum { HEADER = 80, TRIANGLE = 50 }; /* bytes */

static uint32_t u32_at(const char *bytes)
{
    uint32_t word = 0;
    for (int i = 0; i < 4; i++)
        word |= (uint32_t)(unsigned char)bytes[i] << (8 * i);
    return word;
}

static status read_binary(struct cursor *r, struct mesh *mesh)
{
    status st = OK;
    const size_t left = (size_t)(r->end - r->begin) - HEADER - 4;
    const uint32_t n = u32_at(r->begin + HEADER);
    if (n > left / TRIANGLE)
        return fail(E_INPUT, "%s: the header declares %u triangles of %d bytes, but only %zu bytes follow",
                    r->path, n, TRIANGLE, left);
    for (uint32_t t = 0; t < n; t++) {
        const char *at = r->begin + HEADER + 4 + (size_t)t * TRIANGLE + 12;
        for (int k = 0; k < 3; k++) {
            double x[3];
            for (int a = 0; a < 3; a++, at += 4) {
                float value;
                memcpy(&value, &(uint32_t){u32_at(at)}, sizeof value);
                if (!(fabsf(value) <= 1e30F))
                    return fail(E_INPUT, "%s: triangle %u: a coordinate is not finite or larger than 1e30",
                                r->path, t + 1);
                x[a] = (double)value;
            }
            TRY(mesh_add_vertex(mesh, x));
        }
        TRY(mesh_add_triangle(mesh, 3 * t, 3 * t + 1, 3 * t + 2));
    }
done:
    return st;
}

/* Skips the keyword if the line starts with it, in upper or lower case. */
static bool line_is(struct cursor *r, const char *word)
{
    const size_t n = strlen(word);
    if ((size_t)(r->end - r->at) < n || strncasecmp(r->at, word, n) != 0 || r->at[n] > ' ')
        return false;
    r->at += n;
    return true;
}

static status read_text(struct cursor *r, struct mesh *mesh)
{
    status st = OK;
    static const char *const keywords[] = {"solid", "facet", "endfacet", "endsolid",
                                           "end",   "color", "attribute"};
    size_t n = 0;
    double x[3];
    for (; r->at < r->end; cursor_next_line(r)) {
        bool known = cursor_at_line_end(r);
        if (known)
            continue;
        if (line_is(r, "outer")) {
            n = 0;
        } else if (line_is(r, "vertex")) {
            for (int a = 0; a < 3; a++)
                TRY(cursor_number(r, &x[a]));
            TRY(mesh_add_vertex(mesh, x));
            const uint32_t last = (uint32_t)mesh->n_vertices - 1;
            if (++n >= 3)
                TRY(mesh_add_triangle(mesh, last - (uint32_t)n + 1, last - 1, last));
        } else if (line_is(r, "endloop")) {
            if (n < 3)
                return cursor_fail(r, "a face has %zu corners, but it needs at least 3", n);
        } else {
            for (size_t i = 0; !known && i < sizeof keywords / sizeof *keywords; i++)
                known = line_is(r, keywords[i]);
            if (!known)
                return cursor_fail(r, "not a line of an STL file");
        }
    }
done:
    return st;
}

status stl_read(struct cursor *r, struct mesh *mesh)
{
    const size_t size = (size_t)(r->end - r->begin);
    const bool is_binary =
        size >= HEADER + 4 &&
        size == HEADER + 4 +
                    (size_t)TRIANGLE * u32_at(r->begin + HEADER); /* even if its header starts with "solid" */
    while (r->at < r->end && cursor_at_line_end(r))
        cursor_next_line(r);
    const bool text = !is_binary && line_is(r, "solid");
    if (!text && size < HEADER + 4)
        return fail(E_INPUT, "%s: neither a text nor a binary STL file", r->path);
    if (text)
        cursor_next_line(r);
    return text ? read_text(r, mesh) : read_binary(r, mesh);
}
