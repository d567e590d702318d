#include "meshinput/edges.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"

static int compare(const void *a, const void *b)
{
    const struct mesh_side *p = a, *q = b;
    if (p->to != q->to)
        return p->to < q->to ? -1 : 1;
    if (p->triangle != q->triangle)
        return p->triangle < q->triangle ? -1 : 1;
    return p->direction - q->direction;
}

/* Insertion sort for the few half-edges that most vertices have. */
static void sort_sides(struct mesh_side *side, size_t n)
{
    if (n > 32) {
        qsort(side, n, sizeof *side, compare);
        return;
    }
    for (size_t i = 1; i < n; i++) {
        const struct mesh_side s = side[i];
        size_t k = i;
        for (; k > 0 && compare(&side[k - 1], &s) > 0; k--)
            side[k] = side[k - 1];
        side[k] = s;
    }
}

status mesh_edges_create(const struct mesh *mesh, struct mesh_edges *out)
{
    status st = OK;
    *out = (struct mesh_edges){.n_vertices = mesh->n_vertices};
    TRY(memory_alloc(mesh->n_vertices + 2, sizeof *out->begin, "the edges of a mesh", &out->begin));
    TRY(memory_alloc(3 * mesh->n_triangles, sizeof *out->side, "the edges of a mesh", &out->side));
    /* Counting sort. First begin[v + 2] counts; then begin[v + 1] is where v's next half-edge goes, which ends at the begin of v + 1. */
    for (size_t i = 0; i < 3 * mesh->n_triangles; i++) {
        const uint32_t a = mesh->triangle[i / 3][i % 3], b = mesh->triangle[i / 3][(i + 1) % 3];
        out->begin[(a < b ? a : b) + 2]++;
    }
    for (size_t v = 0; v < mesh->n_vertices; v++)
        out->begin[v + 2] += out->begin[v + 1];
    for (size_t i = 0; i < 3 * mesh->n_triangles; i++) {
        const uint32_t a = mesh->triangle[i / 3][i % 3], b = mesh->triangle[i / 3][(i + 1) % 3];
        out->side[out->begin[(a < b ? a : b) + 1]++] =
            (struct mesh_side){a < b ? b : a, (uint32_t)(i / 3), a < b ? 1 : -1};
    }
#pragma omp parallel for schedule(dynamic, 4096)
    for (size_t v = 0; v < mesh->n_vertices; v++)
        sort_sides(out->side + out->begin[v], out->begin[v + 1] - out->begin[v]);
done:
    if (st != OK)
        mesh_edges_free(out);
    return st;
}

void mesh_edges_free(struct mesh_edges *edges)
{
    free(edges->begin);
    free(edges->side);
    *edges = (struct mesh_edges){0};
}

size_t mesh_edge_end(const struct mesh_edges *edges, size_t v, size_t first, int *directions)
{
    size_t i = first;
    *directions = 0;
    for (; i < edges->begin[v + 1] && edges->side[i].to == edges->side[first].to; i++)
        *directions += edges->side[i].direction;
    return i;
}

status mesh_find_open(const struct mesh *mesh, struct mesh_open *out)
{
    status st = OK;
    struct mesh_edges edges = {0};
    size_t capacity = 0;
    int directions;
    *out = (struct mesh_open){0};
    TRY(mesh_edges_create(mesh, &edges));
    for (size_t v = 0; v < edges.n_vertices; v++)
        for (size_t i = edges.begin[v], end; i < edges.begin[v + 1]; i = end) {
            end = mesh_edge_end(&edges, v, i, &directions);
            if (directions == 0)
                continue;
            TRY(memory_grow(&out->edge, &capacity, out->n + 1, sizeof *out->edge,
                            "the open edges of a mesh"));
            out->edge[out->n][0] = (uint32_t)v;
            out->edge[out->n++][1] = edges.side[i].to;
        }
done:
    mesh_edges_free(&edges);
    if (st != OK) {
        free(out->edge);
        *out = (struct mesh_open){0};
    }
    return st;
}
