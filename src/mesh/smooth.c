#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "base/vector.h"
#include "mesh/apart.h"
#include "mesh/boxes.h"

/* Equal weights of opposite sign damp waves of a few edges, keep long ones and amplify none. (Taubin's mu, a little larger than lambda,
 * makes small bodies swell: a block ten voxels wide by 9 % in 50 passes.) The remaining shrinkage is corrected at the end. */
static const double LAMBDA = 0.5, MU = -0.5;
/* cos 20 degrees: neighbours whose normals differ by more do not affect each other. Marching cubes round a right angle over two or three
 * edges. */
static const double SHARP = 0.9396926;

static const uint32_t NO_OTHER = UINT32_MAX, MANY = UINT32_MAX - 1, NOBODY = UINT32_MAX;

/* ---- links between vertices */

struct links {
    size_t *first; /* [n_vertices + 1] */
    uint32_t *to;
};

/* One link per directed edge. In a closed surface the triangles have each edge once in each direction. */
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

/* The other label that a vertex borders on, NO_OTHER or MANY. */
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

/* Removes the links across label borders and sharp edges. */
static status choose_links(const struct trimesh *m, const uint32_t *label, const float *normal,
                           struct links *l)
{
    status st = OK;
    uint32_t *other = NULL;
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
    return st;
}

/* ---- moving */

struct motion {
    const struct trimesh *mesh;
    struct links links;
    double reach;
    float *start, *normal; /* [n_vertices][3] */
    double *out[2];        /* [n_vertices]: offset along the normal, before and after a step */
};

/* The position of a vertex at the offset `out`. */
static void place(const struct motion *m, size_t v, double out, double at[3])
{
    for (size_t d = 0; d < 3; d++)
        at[d] = (double)m->start[3 * v + d] + out * (double)m->normal[3 * v + d];
}

static double within(double x, double reach)
{
    return fmin(fmax(x, -reach), reach);
}

/* Whether a vertex moves. With only one link, the end of a border line would be pulled in. */
static bool moves(const struct motion *m, size_t v)
{
    int pulls = 0;
    for (size_t e = m->links.first[v]; e < m->links.first[v + 1]; e++)
        pulls += m->links.to[e] != NOBODY;
    return pulls > 1;
}

/* One step with weight w. Vertices move only along their normals, so that values on the surface stay in place. */
static void step(const struct motion *m, double w, const double *from, double *to)
{
#pragma omp parallel for
    for (size_t v = 0; v < m->mesh->n_vertices; v++) {
        double mean[3] = {0}, at[3], out = 0;
        int pulls = 0;
        to[v] = from[v];
        if (!moves(m, v))
            continue;
        for (size_t e = m->links.first[v]; e < m->links.first[v + 1]; e++) {
            if (m->links.to[e] == NOBODY)
                continue;
            place(m, m->links.to[e], from[m->links.to[e]], at);
            for (size_t d = 0; d < 3; d++)
                mean[d] += at[d];
            pulls++;
        }
        place(m, v, from[v], at);
        for (size_t d = 0; d < 3; d++)
            out += (mean[d] / pulls - at[d]) * (double)m->normal[3 * v + d];
        to[v] = within(from[v] + w * out, m->reach);
    }
}

static void move_all(const struct motion *m, const double *out, struct trimesh *mesh)
{
    for (size_t v = 0; v < mesh->n_vertices; v++) {
        double at[3];
        place(m, v, out[v], at);
        for (size_t d = 0; d < 3; d++)
            mesh->vertex[3 * v + d] = (float)at[d];
    }
}

/* Restores `volume` by an equal offset of all vertices. */
static void restore_volume(const struct motion *m, double volume, struct trimesh *mesh)
{
    double area = 0;
    for (size_t t = 0; t < mesh->n_triangles; t++) {
        const uint32_t *c = mesh->triangle + 3 * t;
        double x[3][3], e[3], f[3], n[3];
        boxes_corners(mesh, c, x);
        minus3(x[1], x[0], e);
        minus3(x[2], x[0], f);
        cross3(e, f, n);
        for (int k = 0; k < 3; k++)
            area += moves(m, c[k]) ? sqrt(dot3(n, n)) / 6 : 0;
    }
    double more = area > 0 ? (volume - trimesh_volume(mesh)) / area : 0;
    for (size_t v = 0; v < mesh->n_vertices; v++)
        if (moves(m, v))
            m->out[0][v] = within(m->out[0][v] + more, m->reach);
    move_all(m, m->out[0], mesh);
}

/* Marks the corners of triangles that intersect others, and counts the pairs. */
static status find_crossing(const struct trimesh *m, double cell, uint8_t *marked, size_t *n_pairs)
{
    status st = OK, failed = OK;
    struct boxes boxes = {0};
    size_t pairs = 0;
    *n_pairs = 0;
    TRY(boxes_create(&boxes, m, cell));
#pragma omp parallel reduction(+ : pairs)
    {
        struct boxes_found found = {0};
#pragma omp for schedule(dynamic, 512)
        for (size_t t = 0; t < m->n_triangles; t++) {
            const uint32_t *a = m->triangle + 3 * t;
            found.n = 0;
            status own = boxes_find(&boxes, boxes.box[t], &found);
            if (own != OK) {
#pragma omp atomic write
                failed = own;
            }
            for (size_t i = 0; i < found.n; i++) {
                const uint32_t *b = m->triangle + 3 * (size_t)found.triangle[i];
                if (found.triangle[i] <= t || boxes_apart(m, a, b))
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
        st = fail(failed, "out of memory for the triangle grid");
    *n_pairs = pairs;
done:
    boxes_destroy(&boxes);
    return st;
}

/* Moves the vertices of intersecting triangles back, first by halves and then completely, until no triangles intersect. */
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
        boxes_corners(m, m->triangle + 3 * t, x);
        minus3(x[1], x[0], e);
        sum += sqrt(dot3(e, e));
    }
    return m->n_triangles ? sum / (double)m->n_triangles : 1;
}

status trimesh_smooth(struct trimesh *mesh, const uint32_t *label, int passes, double reach)
{
    status st = OK;
    struct motion m = {.mesh = mesh, .reach = reach};
    const size_t n = mesh->n_vertices;
    const double volume = trimesh_volume(mesh);
    if (passes <= 0 || !n)
        return OK;
    TRY(memory_alloc(n, 3 * sizeof *m.start, "a smoother surface", &m.start));
    TRY(memory_alloc(n, 3 * sizeof *m.normal, "a smoother surface", &m.normal));
    TRY(memory_alloc(n, sizeof *m.out[0], "a smoother surface", &m.out[0]));
    TRY(memory_alloc(n, sizeof *m.out[1], "a smoother surface", &m.out[1]));
    memcpy(m.start, mesh->vertex, n * 3 * sizeof *m.start);
    trimesh_normals(mesh, m.normal);
    TRY(make_links(mesh, &m.links));
    TRY(choose_links(mesh, label, m.normal, &m.links));
    for (int pass = 0; pass < passes; pass++) {
        step(&m, LAMBDA, m.out[0], m.out[1]);
        step(&m, MU, m.out[1], m.out[0]);
    }
    move_all(&m, m.out[0], mesh);
    restore_volume(&m, volume, mesh);
    TRY(undo_crossing(mesh, m.start, 3 * mean_edge(mesh)));
done:
    free(m.links.first);
    free(m.links.to);
    free(m.out[0]);
    free(m.out[1]);
    free(m.normal);
    free(m.start);
    return st;
}

status trimesh_crossings(const struct trimesh *mesh, size_t *n)
{
    return find_crossing(mesh, 3 * mean_edge(mesh), NULL, n);
}
