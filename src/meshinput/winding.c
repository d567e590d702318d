/* A complete binary tree over the triangles, sorted along the Morton curve. */
#include "meshinput/winding.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "meshinput/curve.h"

enum { LEAF = 6 };

/* A node's series about its middle: the sum of its triangles' area vectors, and their first moments, symmetrised. */
struct node {
    float middle[3], far_square, area[3], moment[6];
};

struct winding {
    double origin[3];
    size_t n_leaves, n_triangles; /* n_leaves: a power of two */
    float (*corner)[9];           /* [n_triangles], relative to the origin, in Morton order */
    struct node *node;            /* the children of i are 2i and 2i + 1; the root is 1 */
};

struct box {
    double lo[3], hi[3];
};

static void box_add(struct box *box, const double x[3])
{
    for (int a = 0; a < 3; a++) {
        box->lo[a] = fmin(box->lo[a], x[a]);
        box->hi[a] = fmax(box->hi[a], x[a]);
    }
}

static const struct box nothing = {{INFINITY, INFINITY, INFINITY}, {-INFINITY, -INFINITY, -INFINITY}};

/* Copies the triangles in their order along the curve. */
static status copy_corners(struct winding *w, const double (*vertex)[3], const uint32_t (*triangle)[3],
                           const struct box *box)
{
    status st = OK;
    uint32_t *order = NULL;
    TRY(curve_order(vertex, triangle, w->n_triangles, box->lo, box->hi, &order));
    for (size_t t = 0; t < w->n_triangles; t++)
        for (int k = 0; k < 3; k++)
            for (int a = 0; a < 3; a++)
                w->corner[t][3 * k + a] = (float)(vertex[triangle[order[t]][k]][a] - w->origin[a]);
done:
    free(order);
    return st;
}

/* ---- the tree */

/* A node while the tree is built bottom up. */
struct sum {
    struct box box;
    double weight, middle[3], radius, area[3], moment[3][3]; /* weight: m2 */
};

static size_t first_of(const struct winding *w, size_t leaf)
{
    return leaf * w->n_triangles / w->n_leaves;
}

static void area_of(const float corner[9], double area[3])
{
    double u[3], v[3];
    for (int a = 0; a < 3; a++) {
        u[a] = (double)corner[3 + a] - (double)corner[a];
        v[a] = (double)corner[6 + a] - (double)corner[a];
    }
    for (int a = 0; a < 3; a++)
        area[a] = 0.5 * (u[(a + 1) % 3] * v[(a + 2) % 3] - u[(a + 2) % 3] * v[(a + 1) % 3]);
}

/* Adds `more` to `to`, shifting its moments to the middle of `to`. */
static void add_about(struct sum *to, const struct sum *more)
{
    for (int i = 0; i < 3; i++) {
        to->area[i] += more->area[i];
        for (int j = 0; j < 3; j++)
            to->moment[i][j] += more->moment[i][j] + (more->middle[i] - to->middle[i]) * more->area[j];
    }
}

static double distance(const double a[3], const double b[3])
{
    return sqrt((a[0] - b[0]) * (a[0] - b[0]) + (a[1] - b[1]) * (a[1] - b[1]) +
                (a[2] - b[2]) * (a[2] - b[2]));
}

/* The total of n sums, about their weighted middle, or the middle of their box if their weight is 0. */
static struct sum sum_of(const struct sum *part, size_t n)
{
    struct sum s = {.box = nothing};
    for (size_t i = 0; i < n; i++) {
        box_add(&s.box, part[i].box.lo);
        box_add(&s.box, part[i].box.hi);
        s.weight += part[i].weight;
        for (int a = 0; a < 3; a++)
            s.middle[a] += part[i].weight * part[i].middle[a];
    }
    for (int a = 0; a < 3; a++)
        s.middle[a] = s.weight > 0 ? s.middle[a] / s.weight : n > 0 ? (s.box.lo[a] + s.box.hi[a]) / 2 : 0;
    double corner = 0;
    for (int a = 0; a < 3 && n > 0; a++)
        corner = hypot(corner, fmax(s.box.hi[a] - s.middle[a], s.middle[a] - s.box.lo[a]));
    for (size_t i = 0; i < n; i++) {
        add_about(&s, &part[i]);
        s.radius = fmax(s.radius, distance(s.middle, part[i].middle) + part[i].radius);
    }
    s.radius = fmin(s.radius, corner);
    return s;
}

static struct sum sum_of_leaf(const struct winding *w, size_t leaf)
{
    struct sum part[LEAF + 1];
    size_t n = 0;
    for (size_t t = first_of(w, leaf); t < first_of(w, leaf + 1); t++, n++) {
        part[n] = (struct sum){.box = nothing};
        area_of(w->corner[t], part[n].area);
        part[n].weight = sqrt(part[n].area[0] * part[n].area[0] + part[n].area[1] * part[n].area[1] +
                              part[n].area[2] * part[n].area[2]);
        double x[3][3];
        for (int k = 0; k < 3; k++) {
            for (int a = 0; a < 3; a++) {
                x[k][a] = (double)w->corner[t][3 * k + a];
                part[n].middle[a] += x[k][a] / 3;
            }
            box_add(&part[n].box, x[k]);
        }
        for (int k = 0; k < 3; k++)
            part[n].radius = fmax(part[n].radius, distance(part[n].middle, x[k]));
    }
    return sum_of(part, n);
}

static struct node node_of(const struct sum *s, double far)
{
    struct node n;
    for (int a = 0; a < 3; a++) {
        n.middle[a] = (float)s->middle[a];
        n.area[a] = (float)s->area[a];
        n.moment[a] = (float)s->moment[a][a];
        n.moment[3 + a] = (float)(s->moment[a][(a + 1) % 3] + s->moment[(a + 1) % 3][a]);
    }
    n.far_square = (float)(s->radius * s->radius * far * far);
    return n;
}

static status build(struct winding *w, double far)
{
    status st = OK;
    struct sum *sum = NULL;
    TRY(memory_alloc(w->n_leaves, sizeof *sum, "a mesh's winding numbers", &sum));
#pragma omp parallel for schedule(static)
    for (size_t l = 0; l < w->n_leaves; l++) {
        sum[l] = sum_of_leaf(w, l);
        w->node[w->n_leaves + l] = node_of(&sum[l], far);
    }
    for (size_t n = w->n_leaves / 2; n >= 1; n /= 2)
        for (size_t i = 0; i < n; i++) {
            sum[i] = sum_of(&sum[2 * i], 2);
            w->node[n + i] = node_of(&sum[i], far);
        }
done:
    free(sum);
    return st;
}

status winding_create(const double (*vertex)[3], size_t n_vertices, const uint32_t (*triangle)[3],
                      size_t n_triangles, double far, struct winding **out)
{
    status st = OK;
    struct winding *w = NULL;
    struct box box = nothing;
    for (size_t i = 0; i < n_vertices; i++)
        box_add(&box, vertex[i]);
    TRY(memory_alloc(1, sizeof *w, "a mesh's winding numbers", &w));
    w->n_triangles = n_triangles;
    for (w->n_leaves = 1; w->n_leaves * LEAF < n_triangles;)
        w->n_leaves *= 2;
    for (int a = 0; a < 3; a++)
        w->origin[a] = n_vertices ? (box.lo[a] + box.hi[a]) / 2 : 0;
    TRY(memory_alloc(n_triangles, sizeof *w->corner, "a mesh's winding numbers", &w->corner));
    TRY(memory_alloc(2 * w->n_leaves, sizeof *w->node, "a mesh's winding numbers", &w->node));
    TRY(copy_corners(w, vertex, triangle, &box));
    TRY(build(w, far));
    *out = w;
    w = NULL;
done:
    winding_destroy(&w);
    return st;
}

void winding_destroy(struct winding **winding)
{
    if (!*winding)
        return;
    free((*winding)->corner);
    free((*winding)->node);
    free(*winding);
    *winding = NULL;
}

/* ---- evaluation */

/* Half the solid angle of a triangle (Van Oosterom and Strackee 1983). */
static float half_angle(const float c[9], const float x[3])
{
    float v[3][3], length[3];
    for (int k = 0; k < 3; k++) {
        for (int a = 0; a < 3; a++)
            v[k][a] = c[3 * k + a] - x[a];
        length[k] = sqrtf(v[k][0] * v[k][0] + v[k][1] * v[k][1] + v[k][2] * v[k][2]);
    }
    const float volume = v[0][0] * (v[1][1] * v[2][2] - v[1][2] * v[2][1]) +
                         v[0][1] * (v[1][2] * v[2][0] - v[1][0] * v[2][2]) +
                         v[0][2] * (v[1][0] * v[2][1] - v[1][1] * v[2][0]);
    float below = length[0] * length[1] * length[2];
    for (int k = 0; k < 3; k++) {
        const float *p = v[(k + 1) % 3], *q = v[(k + 2) % 3];
        below += length[k] * (p[0] * q[0] + p[1] * q[1] + p[2] * q[2]);
    }
    return volume != 0 || below < 0 ? atan2f(volume, below) : 0;
}

/* The node's contribution times 4 pi, at offset d with square = |d|^2 > 0. */
static float far_field(const struct node *n, const float d[3], float square)
{
    const float *m = n->moment;
    const float inverse = 1 / square, cube = inverse / sqrtf(square);
    const float trace = m[0] + m[1] + m[2];
    const float along = m[0] * d[0] * d[0] + m[1] * d[1] * d[1] + m[2] * d[2] * d[2] + m[3] * d[0] * d[1] +
                        m[4] * d[1] * d[2] + m[5] * d[2] * d[0];
    return cube * (d[0] * n->area[0] + d[1] * n->area[1] + d[2] * n->area[2] + trace - 3 * along * inverse);
}

float winding_number(const struct winding *w, const double x[3])
{
    size_t stack[64], n = 0; /* 2^32 leaves make a depth of 32 */
    const float at[3] = {(float)(x[0] - w->origin[0]), (float)(x[1] - w->origin[1]),
                         (float)(x[2] - w->origin[2])};
    float near = 0, far = 0;
    stack[n++] = 1;
    while (n > 0) {
        const size_t i = stack[--n];
        const struct node *node = &w->node[i];
        const float d[3] = {node->middle[0] - at[0], node->middle[1] - at[1], node->middle[2] - at[2]};
        const float square = d[0] * d[0] + d[1] * d[1] + d[2] * d[2];
        if (square > node->far_square) {
            far += far_field(node, d, square);
        } else if (i < w->n_leaves) {
            stack[n++] = 2 * i + 1;
            stack[n++] = 2 * i;
        } else {
            for (size_t t = first_of(w, i - w->n_leaves); t < first_of(w, i - w->n_leaves + 1); t++)
                near += half_angle(w->corner[t], at);
        }
    }
    return (2 * near + far) / (float)(4 * M_PI);
}

void winding_numbers(const struct winding *w, const double (*x)[3], size_t n, float *number)
{
#pragma omp parallel for schedule(dynamic, 256)
    for (size_t i = 0; i < n; i++)
        number[i] = winding_number(w, x[i]);
}
