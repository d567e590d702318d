/* A complete binary tree of boxes over the triangles in their order along the Morton curve. */
#include "meshinput/nearest.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "base/vector.h"
#include "meshinput/curve.h"

enum { LEAF = 4, STACK = 64 };

struct box {
    double lo[3], hi[3];
};

struct nearest {
    const struct mesh *mesh;
    uint32_t *order;
    size_t n_leaves;  /* a power of two */
    struct box *node; /* the children of i are 2i and 2i + 1; the root is 1 */
};

static const struct box nothing = {{INFINITY, INFINITY, INFINITY}, {-INFINITY, -INFINITY, -INFINITY}};

static void box_add(struct box *box, const double x[3])
{
    for (int a = 0; a < 3; a++) {
        box->lo[a] = fmin(box->lo[a], x[a]);
        box->hi[a] = fmax(box->hi[a], x[a]);
    }
}

static size_t first_of(const struct nearest *n, size_t leaf)
{
    return leaf * n->mesh->n_triangles / n->n_leaves;
}

static void build(struct nearest *n)
{
    const struct mesh *m = n->mesh;
    for (size_t leaf = 0; leaf < n->n_leaves; leaf++) {
        struct box *box = &n->node[n->n_leaves + leaf];
        *box = nothing;
        for (size_t i = first_of(n, leaf); i < first_of(n, leaf + 1); i++)
            for (int k = 0; k < 3; k++)
                box_add(box, m->vertex[m->triangle[n->order[i]][k]]);
    }
    for (size_t i = n->n_leaves - 1; i >= 1; i--) {
        n->node[i] = n->node[2 * i];
        box_add(&n->node[i], n->node[2 * i + 1].lo);
        box_add(&n->node[i], n->node[2 * i + 1].hi);
    }
}

status nearest_create(const struct mesh *mesh, struct nearest **out)
{
    status st = OK;
    struct nearest *n = NULL;
    struct box box = nothing;
    for (size_t i = 0; i < mesh->n_vertices; i++)
        box_add(&box, mesh->vertex[i]);
    TRY(memory_alloc(1, sizeof *n, "a mesh's boxes", &n));
    n->mesh = mesh;
    for (n->n_leaves = 1; n->n_leaves * LEAF < mesh->n_triangles;)
        n->n_leaves *= 2;
    TRY(memory_alloc(2 * n->n_leaves, sizeof *n->node, "a mesh's boxes", &n->node));
    TRY(curve_order((const double(*)[3])mesh->vertex, (const uint32_t(*)[3])mesh->triangle, mesh->n_triangles,
                    box.lo, box.hi, &n->order));
    build(n);
    *out = n;
    n = NULL;
done:
    nearest_destroy(&n);
    return st;
}

void nearest_destroy(struct nearest **nearest)
{
    if (!*nearest)
        return;
    free((*nearest)->order);
    free((*nearest)->node);
    free(*nearest);
    *nearest = NULL;
}

/* Infinite for an empty box. */
static double square_to_box(const struct box *box, const double x[3])
{
    double square = 0;
    for (int a = 0; a < 3; a++) {
        const double d = fmax(0, fmax(box->lo[a] - x[a], x[a] - box->hi[a]));
        square += d * d;
    }
    return square;
}

/* The nearest point of a segment: the weight of `b`. */
static double along_segment(const double a[3], const double b[3], const double x[3])
{
    double ab[3], ax[3];
    minus3(b, a, ab);
    minus3(x, a, ax);
    const double square = dot3(ab, ab);
    return square > 0 ? fmin(fmax(dot3(ab, ax) / square, 0), 1) : 0;
}

static double square_at(const double *const corner[3], const double weight[3], const double x[3])
{
    double square = 0;
    for (int a = 0; a < 3; a++) {
        const double d =
            weight[0] * corner[0][a] + weight[1] * corner[1][a] + weight[2] * corner[2][a] - x[a];
        square += d * d;
    }
    return square;
}

/* The nearest point of a triangle: the foot of the perpendicular if it is inside, else on one of the edges. Returns the squared distance. */
static double in_triangle(const double *const corner[3], const double x[3], double weight[3])
{
    double u[3], v[3], d[3], best = INFINITY;
    minus3(corner[1], corner[0], u);
    minus3(corner[2], corner[0], v);
    minus3(x, corner[0], d);
    const double uu = dot3(u, u), uv = dot3(u, v), vv = dot3(v, v), du = dot3(d, u), dv = dot3(d, v);
    const double area = uu * vv - uv * uv;
    const double s = (vv * du - uv * dv) / area,
                 t = (uu * dv - uv * du) / area; /* not finite if degenerate */
    if (s >= 0 && t >= 0 && s + t <= 1) {
        weight[0] = 1 - s - t;
        weight[1] = s;
        weight[2] = t;
        return square_at(corner, weight, x);
    }
    for (int k = 0; k < 3; k++) {
        double w[3] = {0, 0, 0};
        w[(k + 1) % 3] = along_segment(corner[k], corner[(k + 1) % 3], x);
        w[k] = 1 - w[(k + 1) % 3];
        const double square = square_at(corner, w, x);
        if (square < best) {
            best = square;
            memcpy(weight, w, sizeof w);
        }
    }
    return best;
}

static void search_leaf(const struct nearest *n, size_t leaf, const double x[3], struct nearest_point *out,
                        double *best)
{
    const struct mesh *m = n->mesh;
    for (size_t i = first_of(n, leaf); i < first_of(n, leaf + 1); i++) {
        const uint32_t t = n->order[i];
        const double *const corner[3] = {m->vertex[m->triangle[t][0]], m->vertex[m->triangle[t][1]],
                                         m->vertex[m->triangle[t][2]]};
        double weight[3] = {1, 0, 0};
        const double square = in_triangle(corner, x, weight);
        if (square < *best || (square == *best && t < out->triangle)) {
            *best = square;
            out->triangle = t;
            memcpy(out->weight, weight, sizeof weight);
        }
    }
}

bool nearest_find(const struct nearest *n, const double x[3], double within, struct nearest_point *out)
{
    struct entry {
        size_t node;
        double square;
    } stack[STACK] = {{1, square_to_box(&n->node[1], x)}};
    size_t depth = 1;
    double best = within * within;
    out->triangle = UINT32_MAX;
    while (depth > 0) {
        const struct entry e = stack[--depth];
        if (e.square > best)
            continue;
        if (e.node >= n->n_leaves) {
            search_leaf(n, e.node - n->n_leaves, x, out, &best);
            continue;
        }
        struct entry near = {2 * e.node, square_to_box(&n->node[2 * e.node], x)};
        struct entry far = {2 * e.node + 1, square_to_box(&n->node[2 * e.node + 1], x)};
        if (far.square < near.square) {
            const struct entry swap = near;
            near = far;
            far = swap;
        }
        stack[depth++] = far;
        stack[depth++] = near;
    }
    out->distance = sqrt(best);
    return out->triangle != UINT32_MAX;
}
