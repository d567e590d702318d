#include <float.h>
#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "mesh/trimesh.h"

/* ---- removing ambiguous faces */

struct samples {
    const struct trimesh_lattice *l;
    float *value;
    ptrdiff_t step[3];
    size_t n;
};

/* If the face with the corners from, from + a, from + b, from + a + b is ambiguous, the corner that must become inside, else -1. */
static ptrdiff_t ambiguous(const struct samples *s, size_t from, int a, int b)
{
    const float *v = s->value + from;
    ptrdiff_t at[4] = {0, s->step[a], s->step[a] + s->step[b], s->step[b]};
    bool in[4];
    for (int c = 0; c < 4; c++)
        in[c] = v[at[c]] < 0;
    if (in[0] != in[2] || in[1] != in[3] || in[0] == in[1])
        return -1;
    ptrdiff_t one = in[0] ? at[1] : at[0], other = in[0] ? at[3] : at[2];
    return (ptrdiff_t)from + (v[one] <= v[other] ? one : other);
}

/* A stack of samples whose faces must be checked again. */
struct pending {
    size_t *at, n, capacity;
};

/* Makes a sample barely inside, so that as little volume as possible is added. */
static status turn_inside(struct samples *s, size_t at, struct pending *p)
{
    status st = OK;
    s->value[at] = (float)(-0.001 * s->l->voxel);
    TRY(memory_grow(&p->at, &p->capacity, p->n + 1, sizeof *p->at, "ambiguous samples"));
    p->at[p->n++] = at;
done:
    return st;
}

/* Terminates, because samples only change from outside to inside. Samples at the border never change, because a face with an edge on the
 * border cannot be ambiguous. */
static status make_unambiguous(struct samples *s)
{
    status st = OK;
    struct pending p = {0};
    const int *n = s->l->n;
    for (int a = 0; a < 3; a++)
        for (int b = a + 1; b < 3; b++)
            for (int k = 0; k < n[2] - (b == 2); k++)
                for (int j = 0; j < n[1] - (a == 1 || b == 1); j++)
                    for (int i = 0; i < n[0] - (a == 0); i++) {
                        size_t from = ((size_t)k * (size_t)n[1] + (size_t)j) * (size_t)n[0] + (size_t)i;
                        ptrdiff_t turned = ambiguous(s, from, a, b);
                        if (turned >= 0)
                            TRY(turn_inside(s, (size_t)turned, &p));
                    }
    while (p.n) {
        size_t at = p.at[--p.n];
        /* The twelve faces with this corner; inside samples are never at the border. */
        for (int a = 0; a < 3; a++)
            for (int b = a + 1; b < 3; b++)
                for (int c = 0; c < 4; c++) {
                    ptrdiff_t from = (ptrdiff_t)at - (c & 1 ? s->step[a] : 0) - (c >> 1 ? s->step[b] : 0);
                    ptrdiff_t turned = ambiguous(s, (size_t)from, a, b);
                    if (turned >= 0)
                        TRY(turn_inside(s, (size_t)turned, &p));
                }
    }
done:
    free(p.at);
    return st;
}

/* ---- the cases */

/* Corners of a cell are numbered with the bits x, y, z; edges with axis * 4 + the bits of the other two axes, lower axis first. */
enum { EDGES = 12, CASES = 256, NONE = -1 };

struct polygons {
    int8_t n, size[4]; /* at most four polygons, and the number of their edges */
    int8_t edge[EDGES];
};

static int edge_between(int c, int d)
{
    int axis = (c ^ d) == 1 ? 0 : (c ^ d) == 2 ? 1 : 2, low = c & d;
    int other = axis == 0 ? low >> 1 : axis == 1 ? (low & 1) | (low >> 1 & 2) : low & 3;
    return 4 * axis + other;
}

/* The polygons of a case. Each face with crossed edges has one segment, and the segments form cycles. Cases with an ambiguous face do
 * not occur and get no polygons. */
static struct polygons trace(unsigned inside)
{
    struct polygons p = {0};
    int8_t next[EDGES];
    bool done[EDGES] = {false};
    memset(next, NONE, sizeof next);
    for (int axis = 0; axis < 3; axis++)
        for (int side = 0; side < 2; side++) {
            /* Counter-clockwise as seen from outside the cell. */
            int u = 1 << (axis + 1) % 3, v = 1 << (axis + 2) % 3, base = side << axis;
            int ring[4] = {base, base | u, base | u | v, base | v}, in = NONE, out = NONE;
            if (!side)
                ring[1] = base | v, ring[3] = base | u;
            for (int c = 0; c < 4; c++) {
                int from = ring[c], to = ring[(c + 1) % 4];
                bool a = inside >> from & 1, b = inside >> to & 1;
                if (!a && b && in != NONE)
                    return p;
                if (!a && b)
                    in = edge_between(from, to);
                if (a && !b)
                    out = edge_between(from, to);
            }
            if (in != NONE)
                next[in] = (int8_t)out;
        }
    int at = 0;
    for (int e = 0; e < EDGES; e++) {
        if (next[e] == NONE || done[e])
            continue;
        int from = at;
        for (int f = e; !done[f]; f = next[f]) {
            done[f] = true;
            p.edge[at++] = (int8_t)f;
        }
        p.size[p.n++] = (int8_t)(at - from);
    }
    return p;
}

/* ---- the surface */

struct march {
    struct samples s;
    struct polygons cases[CASES];
    size_t *first_vertex, *first_triangle; /* for each layer of samples, and of the cells above it */
    struct trimesh *out;
};

static bool crossed(const struct march *m, size_t at, int axis)
{
    return (m->s.value[at] < 0) != (m->s.value[at + (size_t)m->s.step[axis]] < 0);
}

/* Sets the position of the vertex on the edge from sample x along `axis`. */
static void place(const struct march *m, const int x[3], size_t at, int axis, float to[3])
{
    const struct trimesh_lattice *l = m->s.l;
    double a = (double)m->s.value[at], b = (double)m->s.value[at + (size_t)m->s.step[axis]];
    double t = fmin(fmax(a / (a - b), TRIMESH_CLEARANCE), 1 - TRIMESH_CLEARANCE);
    for (int d = 0; d < 3; d++)
        to[d] = (float)(l->origin[d] + l->voxel * (x[d] + (d == axis ? t : 0)));
}

/* Visits the vertices of layer k in order and returns their number. Writes their positions to `vertex` and their indices to
 * id[axis][j nx + i], unless these are NULL. */
static size_t layer_vertices(const struct march *m, int k, float *vertex, uint32_t *id[3])
{
    const int *n = m->s.l->n;
    size_t count = 0, at = (size_t)k * (size_t)m->s.step[2];
    for (int j = 0; j < n[1]; j++)
        for (int i = 0; i < n[0]; i++, at++)
            for (int axis = 0; axis < 3; axis++) {
                const int x[3] = {i, j, k};
                if (x[axis] == n[axis] - 1 || !crossed(m, at, axis))
                    continue;
                if (vertex)
                    place(m, x, at, axis, vertex + 3 * (m->first_vertex[k] + count));
                if (id)
                    id[axis][j * n[0] + i] = (uint32_t)(m->first_vertex[k] + count);
                count++;
            }
    return count;
}

static unsigned case_at(const struct march *m, size_t at)
{
    unsigned inside = 0;
    for (unsigned c = 0; c < 8; c++) {
        size_t corner =
            at + (c & 1 ? 1 : 0) + (c & 2 ? (size_t)m->s.step[1] : 0) + (c & 4 ? (size_t)m->s.step[2] : 0);
        inside |= (m->s.value[corner] < 0 ? 1u : 0u) << c;
    }
    return inside;
}

static size_t layer_triangles(const struct march *m, int k)
{
    const int *n = m->s.l->n;
    size_t count = 0;
    for (int j = 0; j + 1 < n[1]; j++)
        for (int i = 0; i + 1 < n[0]; i++) {
            const struct polygons *p =
                &m->cases[case_at(m, (size_t)(k * m->s.step[2] + j * m->s.step[1] + i))];
            for (int q = 0; q < p->n; q++)
                count += (size_t)p->size[q] - 2;
        }
    return count;
}

static double squared_distance(const float *a, const float *b)
{
    double sum = 0;
    for (int d = 0; d < 3; d++)
        sum += ((double)a[d] - (double)b[d]) * ((double)a[d] - (double)b[d]);
    return sum;
}

/* Triangulates a polygon by cutting off the corner with the shortest diagonal. Returns the end of the triangles written. */
static uint32_t *cut(const float *vertex, uint32_t *corner, int n, uint32_t *to)
{
    while (n >= 3) {
        int best = 1;
        double shortest = INFINITY;
        for (int c = 0; c < n && n > 3; c++) {
            double d = squared_distance(vertex + 3 * (size_t)corner[(c + n - 1) % n],
                                        vertex + 3 * (size_t)corner[(c + 1) % n]);
            if (d < shortest) {
                shortest = d;
                best = c;
            }
        }
        *to++ = corner[(best + n - 1) % n];
        *to++ = corner[best];
        *to++ = corner[(best + 1) % n];
        n--;
        for (int c = best; c < n; c++)
            corner[c] = corner[c + 1];
    }
    return to;
}

/* Writes the triangles of the cells between layers k and k + 1; id[layer][axis] are the indices of their vertices. */
static void fill_triangles(const struct march *m, int k, uint32_t *id[2][3])
{
    const int *n = m->s.l->n;
    uint32_t *to = m->out->triangle + 3 * m->first_triangle[k];
    for (int j = 0; j + 1 < n[1]; j++)
        for (int i = 0; i + 1 < n[0]; i++) {
            const struct polygons *p =
                &m->cases[case_at(m, (size_t)(k * m->s.step[2] + j * m->s.step[1] + i))];
            const int8_t *edge = p->edge;
            for (int q = 0; q < p->n; edge += p->size[q++]) {
                uint32_t corner[EDGES];
                for (int c = 0; c < p->size[q]; c++) {
                    int axis = edge[c] / 4, o = edge[c] % 4;
                    int x = axis == 0 ? 0 : o & 1, y = axis == 0 ? o & 1 : axis == 1 ? 0 : o >> 1;
                    int z = axis == 2 ? 0 : o >> 1;
                    corner[c] = id[z][axis][(j + y) * n[0] + i + x];
                }
                to = cut(m->out->vertex, corner, p->size[q], to);
            }
        }
}

/* Each thread keeps the vertex indices of two layers at a time, by edge. */
static status all_triangles(const struct march *m)
{
    const int *n = m->s.l->n;
    const size_t area = (size_t)n[0] * (size_t)n[1];
    status failed = OK;
#pragma omp parallel
    {
        uint32_t *memory = NULL;
        status st = memory_alloc(6 * area, sizeof *memory, "the surface's edges", &memory);
        if (st != OK) {
#pragma omp critical
            failed = st;
        }
#pragma omp for schedule(dynamic)
        for (int k = 0; k < n[2] - 1; k++) {
            if (!memory || m->first_triangle[k] == m->first_triangle[k + 1])
                continue;
            uint32_t *id[2][3];
            for (size_t e = 0; e < 6; e++)
                id[e / 3][e % 3] = memory + e * area;
            layer_vertices(m, k, NULL, id[0]);
            layer_vertices(m, k + 1, NULL, id[1]);
            fill_triangles(m, k, id);
        }
        free(memory);
    }
    return failed == OK ? OK : fail(failed, "out of memory for the surface's edges");
}

/* Makes the border and samples that are not finite outside. */
static void close_border(struct samples *s)
{
    const int *n = s->l->n;
    const float outside = (float)s->l->voxel;
#pragma omp parallel for
    for (int k = 0; k < n[2]; k++)
        for (int j = 0; j < n[1]; j++)
            for (int i = 0; i < n[0]; i++) {
                float *v = s->value + (k * s->step[2] + j * s->step[1] + i);
                bool border = i == 0 || j == 0 || k == 0 || i == n[0] - 1 || j == n[1] - 1 || k == n[2] - 1;
                if (!isfinite(*v) || (border && *v < 0))
                    *v = outside;
            }
}

static status check_lattice(const struct trimesh_lattice *l)
{
    for (int a = 0; a < 3; a++) {
        double far = fmax(fabs(l->origin[a]), fabs(l->origin[a] + l->voxel * l->n[a]));
        if (!(l->voxel * TRIMESH_CLEARANCE > 4 * (double)FLT_EPSILON * far))
            return fail(E_INPUT,
                        "voxels of %g m at %g m from the origin are too small for the precision of floats",
                        l->voxel, far);
    }
    return OK;
}

status trimesh_march(float *field, const struct trimesh_lattice *l, struct trimesh *out)
{
    status st = OK;
    struct march m = {.s = {.l = l, .value = field, .step = {1, l->n[0], (ptrdiff_t)l->n[0] * l->n[1]}},
                      .out = out};
    const int layers = l->n[2];
    *out = (struct trimesh){0};
    TRY(check_lattice(l));
    close_border(&m.s);
    TRY(make_unambiguous(&m.s));
    for (unsigned c = 0; c < CASES; c++)
        m.cases[c] = trace(c);
    TRY(memory_alloc((size_t)layers + 1, sizeof *m.first_vertex, "the surface", &m.first_vertex));
    TRY(memory_alloc((size_t)layers + 1, sizeof *m.first_triangle, "the surface", &m.first_triangle));
#pragma omp parallel for schedule(dynamic)
    for (int k = 0; k < layers; k++) {
        m.first_vertex[k + 1] = layer_vertices(&m, k, NULL, NULL);
        m.first_triangle[k + 1] = k < layers - 1 ? layer_triangles(&m, k) : 0;
    }
    for (int k = 0; k < layers; k++) {
        m.first_vertex[k + 1] += m.first_vertex[k];
        m.first_triangle[k + 1] += m.first_triangle[k];
    }
    out->n_vertices = m.first_vertex[layers];
    out->n_triangles = m.first_triangle[layers];
    if (out->n_vertices > UINT32_MAX) {
        st = fail(E_INPUT, "the surface has more than 2^32 vertices");
        goto done;
    }
    TRY(memory_alloc(out->n_vertices, 3 * sizeof *out->vertex, "the surface's vertices", &out->vertex));
    TRY(memory_alloc(out->n_triangles, 3 * sizeof *out->triangle, "the surface's triangles", &out->triangle));
#pragma omp parallel for schedule(dynamic)
    for (int k = 0; k < layers; k++)
        layer_vertices(&m, k, out->vertex, NULL);
    TRY(all_triangles(&m));
done:
    free(m.first_vertex);
    free(m.first_triangle);
    if (st != OK)
        trimesh_free(out);
    return st;
}

void trimesh_free(struct trimesh *mesh)
{
    free(mesh->vertex);
    free(mesh->triangle);
    *mesh = (struct trimesh){0};
}
