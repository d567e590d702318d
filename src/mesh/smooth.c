#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "mesh/apart.h"
#include "mesh/near.h"

/* Taubin's pair for a pass band of about 0.1: what is longer than a few edges stays. */
static const double LAMBDA = 0.5, MU = -0.53;
/* Neighbours whose normals differ by more do not move each other: cos 45 degrees. */
static const double SHARP = 0.70710678;

static const uint32_t NO_OTHER = UINT32_MAX, MANY = UINT32_MAX - 1, NOBODY = UINT32_MAX;

/* ---- what moves with what */

struct links {
    size_t *first; /* [n_vertices + 1] */
    uint32_t *to;
};

/* Both ways along every edge: a closed surface has each edge once in each direction. */
static status make_links(const struct trimesh *m, struct links *l)
{
    status st = OK;
    size_t n = 3 * m->n_triangles, *at = NULL;
    TRY(memory_alloc(m->n_vertices + 1, sizeof *l->first, "a surface's edges", &l->first));
    TRY(memory_alloc(m->n_vertices + 1, sizeof *at, "a surface's edges", &at));
    TRY(memory_alloc(n, sizeof *l->to, "a surface's edges", &l->to));
    for (size_t i = 0; i < n; i++)
        l->first[m->triangle[i] + 1]++;
    for (size_t v = 0; v < m->n_vertices; v++)
        at[v + 1] = l->first[v + 1] += l->first[v];
    for (size_t i = 0; i < n; i++)
        l->to[at[m->triangle[i]]++] = m->triangle[i % 3 == 2 ? i - 2 : i + 1];
done:
    free(at);
    return st;
}

/* The label a vertex borders on: NO_OTHER, or MANY. */
static uint32_t other_label(const struct links *l, const uint32_t *label, size_t v)
{
    uint32_t other = NO_OTHER;
    for (size_t e = l->first[v]; e < l->first[v + 1]; e++) {
        uint32_t at = label[l->to[e]];
        if (at != label[v])
            other = other == NO_OTHER || other == at ? at : MANY;
    }
    return other;
}

/* Takes out the links that may not pull. */
static status choose_links(const struct trimesh *m, const uint32_t *label, struct links *l)
{
    status st = OK;
    uint32_t *other = NULL;
    float *normal = NULL;
    TRY(memory_alloc(m->n_vertices, 3 * sizeof *normal, "normals", &normal));
    trimesh_normals(m, normal);
    if (label) {
        TRY(memory_alloc(m->n_vertices, sizeof *other, "borders of labels", &other));
        for (size_t v = 0; v < m->n_vertices; v++)
            other[v] = other_label(l, label, v);
    }
    for (size_t v = 0; v < m->n_vertices; v++) {
        const float *n = normal + 3 * v;
        for (size_t e = l->first[v]; e < l->first[v + 1]; e++) {
            uint32_t to = l->to[e];
            const float *k = normal + 3 * (size_t)to;
            double cosine =
                (double)n[0] * (double)k[0] + (double)n[1] * (double)k[1] + (double)n[2] * (double)k[2];
            bool pulls = cosine > SHARP;
            if (label)
                pulls &= label[to] == label[v] && other[v] != MANY &&
                         (other[v] == NO_OTHER || other[to] == other[v]);
            if (!pulls)
                l->to[e] = NOBODY;
        }
    }
done:
    free(other);
    free(normal);
    return st;
}

/* ---- moving */

/* One step of weight w: from `from` into `to`, no farther than `reach` from `start`. */
static void step(const struct links *l, size_t n, double w, double reach, const float *start,
                 const double *from, double *to)
{
#pragma omp parallel for
    for (size_t v = 0; v < n; v++) {
        double mean[3] = {0}, away[3], length2 = 0;
        int pulls = 0;
        for (size_t e = l->first[v]; e < l->first[v + 1]; e++) {
            if (l->to[e] == NOBODY)
                continue;
            for (size_t d = 0; d < 3; d++)
                mean[d] += from[3 * (size_t)l->to[e] + d];
            pulls++;
        }
        for (size_t d = 0; d < 3; d++) {
            /* One alone would only pull the end of a line in. */
            double x = from[3 * v + d], move = pulls > 1 ? w * (mean[d] / pulls - x) : 0;
            away[d] = x + move - (double)start[3 * v + d];
            length2 += away[d] * away[d];
        }
        double share = length2 > reach * reach ? reach / sqrt(length2) : 1;
        for (size_t d = 0; d < 3; d++)
            to[3 * v + d] = (double)start[3 * v + d] + share * away[d];
    }
}

/* Marks the corners of triangles that cross others; how many triangles. */
static status find_crossing(const struct trimesh *m, double cell, uint8_t *marked, size_t *n_pairs)
{
    status st = OK, failed = OK;
    struct near near = {0};
    size_t pairs = 0;
    *n_pairs = 0;
    TRY(near_create(&near, m, cell));
#pragma omp parallel reduction(+ : pairs)
    {
        struct near_found found = {0};
#pragma omp for schedule(dynamic, 512)
        for (size_t t = 0; t < m->n_triangles; t++) {
            const uint32_t *a = m->triangle + 3 * t;
            found.n = 0;
            status own = near_find(&near, near.box[t], &found);
            if (own != OK) {
#pragma omp atomic write
                failed = own;
            }
            for (size_t i = 0; i < found.n; i++) {
                const uint32_t *b = m->triangle + 3 * (size_t)found.triangle[i];
                if (found.triangle[i] <= t || near_apart(m, a, b))
                    continue;
                pairs++;
                for (int k = 0; k < 3 && marked; k++) {
#pragma omp atomic write
                    marked[a[k]] = 1;
#pragma omp atomic write
                    marked[b[k]] = 1;
                }
            }
        }
        free(found.triangle);
    }
    if (failed != OK)
        st = fail(failed, "out of memory for near triangles");
    *n_pairs = pairs;
done:
    near_destroy(&near);
    return st;
}

/* Moves back what crosses, by halves and then wholly, until nothing does. */
static status undo_crossing(struct trimesh *m, const float *start, double cell)
{
    enum { HALVES = 3 };
    status st = OK;
    uint8_t *marked = NULL;
    size_t pairs = 0;
    bool moved = true;
    TRY(memory_alloc(m->n_vertices, sizeof *marked, "vertices that cross", &marked));
    for (int round = 0; moved; round++) {
        memset(marked, 0, m->n_vertices);
        moved = false;
        TRY(find_crossing(m, cell, marked, &pairs));
        for (size_t i = 0; i < 3 * m->n_vertices; i++) {
            if (!marked[i / 3] || m->vertex[i] == start[i])
                continue;
            m->vertex[i] = round < HALVES ? 0.5f * (m->vertex[i] + start[i]) : start[i];
            moved = true;
        }
    }
done:
    free(marked);
    return st;
}

static double mean_edge(const struct trimesh *m)
{
    double sum = 0;
    for (size_t t = 0; t < m->n_triangles; t++) {
        double x[3][3], e[3];
        near_corners(m, m->triangle + 3 * t, x);
        minus3(x[1], x[0], e);
        sum += sqrt(dot3(e, e));
    }
    return m->n_triangles ? sum / (double)m->n_triangles : 1;
}

status trimesh_smooth(struct trimesh *mesh, const uint32_t *label, int passes, double reach)
{
    status st = OK;
    struct links links = {0};
    double *now = NULL, *then = NULL;
    float *start = NULL;
    const size_t n = mesh->n_vertices;
    TRY(memory_alloc(n, 3 * sizeof *start, "a smoother surface", &start));
    TRY(memory_alloc(n, 3 * sizeof *now, "a smoother surface", &now));
    TRY(memory_alloc(n, 3 * sizeof *then, "a smoother surface", &then));
    TRY(make_links(mesh, &links));
    TRY(choose_links(mesh, label, &links));
    for (size_t i = 0; i < 3 * n; i++)
        now[i] = (double)(start[i] = mesh->vertex[i]);
    for (int pass = 0; pass < passes; pass++) {
        step(&links, n, LAMBDA, reach, start, now, then);
        step(&links, n, MU, reach, start, then, now);
    }
    for (size_t i = 0; i < 3 * n; i++)
        mesh->vertex[i] = (float)now[i];
    if (passes > 0)
        TRY(undo_crossing(mesh, start, 3 * mean_edge(mesh)));
done:
    free(links.first);
    free(links.to);
    free(now);
    free(then);
    free(start);
    return st;
}

status trimesh_crossings(const struct trimesh *mesh, size_t *n)
{
    return find_crossing(mesh, 3 * mean_edge(mesh), NULL, n);
}
