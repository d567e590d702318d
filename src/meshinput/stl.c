/* STL: triangles with corners of their own, as floats or as text. */
#include <math.h>
#include <string.h>
#include <strings.h>

#include "meshinput/read.h"

enum { HEAD = 80, ONE = 50 };

static uint32_t word_at(const char *bytes)
{
    uint32_t word = 0;
    for (int i = 0; i < 4; i++)
        word |= (uint32_t)(unsigned char)bytes[i] << (8 * i);
    return word;
}

static status read_binary(struct reader *r, struct mesh *mesh)
{
    status st = OK;
    const size_t left = (size_t)(r->end - r->begin) - HEAD - 4;
    const uint32_t n = word_at(r->begin + HEAD);
    if (n > left / ONE)
        return fail(E_INPUT, "%s: the header claims %u triangles of %d bytes, but %zu bytes are left",
                    r->path, n, ONE, left);
    for (uint32_t t = 0; t < n; t++) {
        const char *at = r->begin + HEAD + 4 + (size_t)t * ONE + 12;
        for (int k = 0; k < 3; k++) {
            double x[3];
            for (int a = 0; a < 3; a++, at += 4) {
                float value;
                memcpy(&value, &(uint32_t){word_at(at)}, sizeof value);
                if (!(fabsf(value) <= 1e30F))
                    return fail(E_INPUT, "%s: triangle %u: a corner that is not a usable number", r->path,
                                t + 1);
                x[a] = (double)value;
            }
            TRY(mesh_add_vertex(mesh, x));
        }
        TRY(mesh_add_triangle(mesh, 3 * t, 3 * t + 1, 3 * t + 2));
    }
done:
    return st;
}

/* Does the line start with this word, in capitals or not? Then steps over it. */
static bool line_is(struct reader *r, const char *word)
{
    const size_t n = strlen(word);
    if ((size_t)(r->end - r->at) < n || strncasecmp(r->at, word, n) != 0 || r->at[n] > ' ')
        return false;
    r->at += n;
    return true;
}

static status read_text(struct reader *r, struct mesh *mesh)
{
    status st = OK;
    static const char *const others[] = {"solid", "facet", "endfacet", "endsolid",
                                         "end",   "color", "attribute"};
    size_t n = 0;
    double x[3];
    for (; r->at < r->end; reader_next_line(r)) {
        bool known = reader_at_line_end(r);
        if (known)
            continue;
        if (line_is(r, "outer")) {
            n = 0;
        } else if (line_is(r, "vertex")) {
            for (int a = 0; a < 3; a++)
                TRY(reader_number(r, &x[a]));
            TRY(mesh_add_vertex(mesh, x));
            const uint32_t last = (uint32_t)mesh->n_vertices - 1;
            if (++n >= 3)
                TRY(mesh_add_triangle(mesh, last - (uint32_t)n + 1, last - 1, last));
        } else if (line_is(r, "endloop")) {
            if (n < 3)
                return reader_fail(r, "a face of %zu corners: it needs 3", n);
        } else {
            for (size_t i = 0; !known && i < sizeof others / sizeof *others; i++)
                known = line_is(r, others[i]);
            if (!known)
                return reader_fail(r, "no line of an STL file");
        }
    }
done:
    return st;
}

status stl_read(struct reader *r, struct mesh *mesh)
{
    const size_t size = (size_t)(r->end - r->begin);
    const bool whole =
        size >= HEAD + 4 &&
        size == HEAD + 4 + (size_t)ONE * word_at(r->begin + HEAD); /* whatever the header says */
    while (r->at < r->end && reader_at_line_end(r))
        reader_next_line(r);
    const bool text = !whole && line_is(r, "solid");
    if (!text && size < HEAD + 4)
        return fail(E_INPUT, "%s: neither a text nor a binary STL file", r->path);
    if (text)
        reader_next_line(r);
    return text ? read_text(r, mesh) : read_binary(r, mesh);
}
