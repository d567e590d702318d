/* Is a mesh closed? Welding first, since exporters split vertices along texture seams and hard edges. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "base/random.h"
#include "scene/meshfile.h"

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

status mesh_weld(struct mesh *mesh)
{
    status st = OK;
    uint32_t *table = NULL, *joined = NULL;
    size_t size = table_size(mesh->n_vertices), n_vertices = 0, n_triangles = 0;
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
    for (size_t i = 0; i < mesh->n_triangles; i++) {
        uint32_t t[3];
        for (int k = 0; k < 3; k++)
            t[k] = joined[mesh->triangle[i][k]];
        if (t[0] != t[1] && t[1] != t[2] && t[2] != t[0])
            memcpy(mesh->triangle[n_triangles++], t, sizeof t);
    }
    mesh->n_triangles = n_triangles;
done:
    free(table);
    free(joined);
    return st;
}

/* ---- edges: a hash table from an edge to the triangles it has, counted up to 2 */

struct edge {
    uint32_t a, b; /* a < b */
    uint32_t n;    /* 0: a free slot */
};

static status count_edges(const struct mesh *mesh, struct edge **out, size_t *size)
{
    status st = OK;
    struct edge *table;
    *size = table_size(3 * mesh->n_triangles);
    TRY(memory_alloc(*size, sizeof *table, "the edges of a mesh", &table));
    for (size_t i = 0; i < 3 * mesh->n_triangles; i++) {
        uint32_t a = mesh->triangle[i / 3][i % 3], b = mesh->triangle[i / 3][(i + 1) % 3];
        struct edge e = {a < b ? a : b, a < b ? b : a, 1};
        size_t slot = ((size_t)random_hash(e.a, e.b, 0, 1) << 32 | random_hash(e.a, e.b, 0, 2)) & (*size - 1);
        while (table[slot].n > 0 && (table[slot].a != e.a || table[slot].b != e.b))
            slot = (slot + 1) & (*size - 1);
        if (table[slot].n == 0)
            table[slot] = e;
        else
            table[slot].n = 2;
    }
    *out = table;
done:
    return st;
}

static uint32_t find_root(uint32_t *parent, uint32_t i)
{
    while (parent[i] != i) {
        parent[i] = parent[parent[i]];
        i = parent[i];
    }
    return i;
}

struct box {
    double min[3], max[3];
};

/* Connected open edges make a hole: the box around each. */
static status measure_holes(const struct mesh *mesh, const struct edge *table, size_t size, double *width)
{
    status st = OK;
    uint32_t *parent = NULL;
    struct box *box = NULL;
    TRY(memory_alloc(mesh->n_vertices, sizeof *parent, "the holes of a mesh", &parent));
    TRY(memory_alloc(mesh->n_vertices, sizeof *box, "the holes of a mesh", &box));
    for (size_t i = 0; i < mesh->n_vertices; i++) {
        parent[i] = (uint32_t)i;
        for (int a = 0; a < 3; a++)
            box[i].min[a] = box[i].max[a] = mesh->vertex[i][a];
    }
    *width = 0;
    for (size_t s = 0; s < size; s++) {
        if (table[s].n != 1)
            continue;
        uint32_t p = find_root(parent, table[s].a), q = find_root(parent, table[s].b);
        double square = 0;
        parent[q] = p;
        for (int a = 0; a < 3; a++) {
            box[p].min[a] = fmin(box[p].min[a], box[q].min[a]);
            box[p].max[a] = fmax(box[p].max[a], box[q].max[a]);
            square += (box[p].max[a] - box[p].min[a]) * (box[p].max[a] - box[p].min[a]);
        }
        *width = fmax(*width, sqrt(square));
    }
done:
    free(parent);
    free(box);
    return st;
}

status mesh_find_holes(const struct mesh *mesh, struct mesh_holes *out)
{
    status st = OK;
    struct edge *table = NULL;
    size_t size;
    *out = (struct mesh_holes){0};
    TRY(count_edges(mesh, &table, &size));
    for (size_t s = 0; s < size; s++) {
        if (table[s].n != 1)
            continue;
        if (out->n_edges++ == 0)
            memcpy(out->first, mesh->vertex[table[s].a], sizeof out->first);
    }
    if (out->n_edges > 0)
        TRY(measure_holes(mesh, table, size, &out->width));
done:
    free(table);
    return st;
}
