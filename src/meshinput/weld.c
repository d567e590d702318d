/* Welds vertices that exporters have split along texture seams and hard edges, with each copy rounded by itself. */
#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "base/random.h"
#include "meshinput/edges.h"

#define FREE UINT32_MAX

/* A power of two that leaves a hash table of n entries at least half empty. */
static size_t table_size(size_t n)
{
    size_t size = 16;
    while (size < 2 * n)
        size *= 2;
    return size;
}

static size_t hash_position(const double x[3])
{
    uint32_t word[6];
    double plain[3] = {x[0] + 0.0, x[1] + 0.0, x[2] + 0.0}; /* -0 is 0 */
    memcpy(word, plain, sizeof word);
    uint32_t low = random_hash(word[0], word[1], word[2], word[3]);
    return (size_t)random_hash(low, word[4], word[5], 1) << 32 | random_hash(low, word[4], word[5], 2);
}

/* Replaces the triangles' vertices by those they were joined to, and drops degenerate triangles. */
static void join(struct mesh *mesh, const uint32_t *joined)
{
    size_t n = 0;
    for (size_t i = 0; i < mesh->n_triangles; i++) {
        uint32_t t[3];
        for (int k = 0; k < 3; k++)
            t[k] = joined[mesh->triangle[i][k]];
        if (t[0] != t[1] && t[1] != t[2] && t[2] != t[0])
            memcpy(mesh->triangle[n++], t, sizeof t);
    }
    mesh->n_triangles = n;
}

status mesh_weld(struct mesh *mesh)
{
    status st = OK;
    uint32_t *table = NULL, *joined = NULL;
    size_t size = table_size(mesh->n_vertices), n_vertices = 0;
    TRY(memory_alloc(size, sizeof *table, "welding a mesh", &table));
    TRY(memory_alloc(mesh->n_vertices, sizeof *joined, "welding a mesh", &joined));
    memset(table, 0xff, size * sizeof *table);
    for (size_t i = 0; i < mesh->n_vertices; i++) {
        const double *x = mesh->vertex[i];
        size_t slot = hash_position(x) & (size - 1);
        for (; table[slot] != FREE; slot = (slot + 1) & (size - 1)) {
            const double *y = mesh->vertex[table[slot]];
            if (x[0] == y[0] && x[1] == y[1] && x[2] == y[2])
                break;
        }
        if (table[slot] == FREE) {
            table[slot] = (uint32_t)n_vertices;
            memmove(mesh->vertex[n_vertices++], x, sizeof *mesh->vertex);
        }
        joined[i] = table[slot];
    }
    mesh->n_vertices = n_vertices;
    join(mesh, joined);
done:
    free(table);
    free(joined);
    return st;
}

/* ---- vertices within a tolerance */

/* Kept vertices by grid cell: a hash table of linked lists, the newest vertex first. */
struct cells {
    double side;
    size_t size;
    uint32_t *newest, *older; /* [size], [n_vertices] */
};

static size_t slot_of(const struct cells *c, const double cell[3])
{
    uint32_t word[3];
    for (int a = 0; a < 3; a++)
        word[a] = (uint32_t)(int64_t)cell[a];
    return random_hash(word[0], word[1], word[2], 3) & (c->size - 1);
}

/* The nearest kept vertex within `tolerance` of x, or FREE; *square is its squared distance. */
static uint32_t nearest(const struct mesh *mesh, const struct cells *c, const double x[3], double tolerance,
                        double *square)
{
    uint32_t found = FREE;
    double lo[3], hi[3];
    *square = tolerance * tolerance;
    for (int a = 0; a < 3; a++) {
        lo[a] = floor((x[a] - tolerance) / c->side);
        hi[a] = floor((x[a] + tolerance) / c->side);
    }
    for (int corner = 0; corner < 8; corner++) {
        const double cell[3] = {corner & 1 ? hi[0] : lo[0], corner & 2 ? hi[1] : lo[1],
                                corner & 4 ? hi[2] : lo[2]};
        if ((corner & 1 && hi[0] == lo[0]) || (corner & 2 && hi[1] == lo[1]) ||
            (corner & 4 && hi[2] == lo[2]))
            continue;
        for (uint32_t v = c->newest[slot_of(c, cell)]; v != FREE; v = c->older[v]) {
            double d = 0;
            for (int a = 0; a < 3; a++)
                d += (mesh->vertex[v][a] - x[a]) * (mesh->vertex[v][a] - x[a]);
            if (d < *square || (d == *square && v < found)) {
                *square = d;
                found = v;
            }
        }
    }
    return found;
}

/* Joins each vertex to the nearest one that is kept. Chains are not followed, so that no vertex moves farther than the tolerance. */
static void join_close(const struct mesh *mesh, const bool *is_open, struct cells *c, double tolerance,
                       uint32_t *joined, struct mesh_welded *out)
{
    for (size_t v = 0; v < mesh->n_vertices; v++) {
        double square, cell[3];
        joined[v] = (uint32_t)v;
        if (!is_open[v])
            continue;
        const uint32_t to = nearest(mesh, c, mesh->vertex[v], tolerance, &square);
        if (to != FREE) {
            joined[v] = to;
            out->n++;
            out->farthest = fmax(out->farthest, sqrt(square));
            continue;
        }
        for (int a = 0; a < 3; a++)
            cell[a] = floor(mesh->vertex[v][a] / c->side);
        const size_t slot = slot_of(c, cell);
        c->older[v] = c->newest[slot];
        c->newest[slot] = (uint32_t)v;
    }
}

status mesh_weld_open(struct mesh *mesh, const struct mesh_open *open, double tolerance,
                      struct mesh_welded *out)
{
    status st = OK;
    struct cells c = {.side = 4 * tolerance, .size = table_size(2 * open->n)};
    bool *is_open = NULL;
    uint32_t *joined = NULL;
    *out = (struct mesh_welded){0};
    TRY(memory_alloc(mesh->n_vertices, sizeof *is_open, "welding a mesh", &is_open));
    TRY(memory_alloc(mesh->n_vertices, sizeof *joined, "welding a mesh", &joined));
    TRY(memory_alloc(mesh->n_vertices, sizeof *c.older, "welding a mesh", &c.older));
    TRY(memory_alloc(c.size, sizeof *c.newest, "welding a mesh", &c.newest));
    memset(c.newest, 0xff, c.size * sizeof *c.newest);
    for (size_t i = 0; i < open->n; i++)
        is_open[open->edge[i][0]] = is_open[open->edge[i][1]] = true;
    join_close(mesh, is_open, &c, tolerance, joined, out);
    join(mesh, joined);
done:
    free(is_open);
    free(joined);
    free(c.older);
    free(c.newest);
    return st;
}
