/* The orientation of faces: consistent with their neighbours, then outwards. */
#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "meshinput/edges.h"
#include "meshinput/winding.h"

static void flip(uint32_t triangle[3])
{
    const uint32_t b = triangle[1];
    triangle[1] = triangle[2];
    triangle[2] = b;
}

void mesh_triangle_normal(const struct mesh *mesh, size_t t, double n[3])
{
    const double *a = mesh->vertex[mesh->triangle[t][0]], *b = mesh->vertex[mesh->triangle[t][1]],
                 *c = mesh->vertex[mesh->triangle[t][2]];
    for (int k = 0; k < 3; k++) {
        const int i = (k + 1) % 3, j = (k + 2) % 3;
        n[k] = 0.5 * ((b[i] - a[i]) * (c[j] - a[j]) - (b[j] - a[j]) * (c[i] - a[i]));
    }
}

double mesh_triangle_area(const struct mesh *mesh, size_t t)
{
    double n[3];
    mesh_triangle_normal(mesh, t, n);
    return sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
}

double mesh_volume(const struct mesh *mesh)
{
    double volume = 0, n[3];
    for (size_t t = 0; t < mesh->n_triangles; t++) {
        mesh_triangle_normal(mesh, t, n);
        for (int a = 0; a < 3; a++)
            volume += n[a] / 3 * (mesh->vertex[mesh->triangle[t][0]][a] - mesh->vertex[0][a]);
    }
    return volume;
}

/* ---- consistent with neighbours */

enum { UNSEEN, KEPT, FLIPPED };

struct patches {
    const struct mesh *mesh;
    const struct mesh_edges *edges;
    unsigned char *state; /* [n_triangles]: UNSEEN, KEPT or FLIPPED */
    uint32_t *queue;
    size_t n_queue;
};

/* The first half-edge of edge k of triangle t, and the edge's lower vertex. */
static size_t side_of(const struct patches *p, size_t t, int k, size_t *v)
{
    const uint32_t a = p->mesh->triangle[t][k], b = p->mesh->triangle[t][(k + 1) % 3];
    const uint32_t to = a < b ? b : a;
    *v = a < b ? a : b;
    size_t lo = p->edges->begin[*v], hi = p->edges->begin[*v + 1];
    while (lo < hi) {
        const size_t middle = lo + (hi - lo) / 2;
        if (p->edges->side[middle].to < to)
            lo = middle + 1;
        else
            hi = middle;
    }
    return lo;
}

/* Adds the neighbours of a triangle to its patch, oriented like it. Edges of more than two triangles separate patches. */
static void visit(struct patches *p, size_t t)
{
    for (int k = 0; k < 3; k++) {
        size_t v;
        int directions;
        const size_t first = side_of(p, t, k, &v);
        if (mesh_edge_end(p->edges, v, first, &directions) != first + 2)
            continue;
        const struct mesh_side *s = p->edges->side + first;
        const size_t other = s[0].triangle == t ? s[1].triangle : s[0].triangle;
        if (p->state[other] != UNSEEN)
            continue;
        const bool alike = s[0].direction != s[1].direction;
        p->state[other] = alike ? p->state[t] : p->state[t] == FLIPPED ? KEPT : FLIPPED;
        p->queue[p->n_queue++] = (uint32_t)other;
    }
}

static void flip_patch(struct mesh *mesh, const struct patches *p, size_t *flipped)
{
    double area[3] = {0};
    for (size_t i = 0; i < p->n_queue; i++)
        area[p->state[p->queue[i]]] += mesh_triangle_area(mesh, p->queue[i]);
    const int minority = area[FLIPPED] <= area[KEPT] ? FLIPPED : KEPT;
    for (size_t i = 0; i < p->n_queue; i++)
        if (p->state[p->queue[i]] == minority) {
            flip(mesh->triangle[p->queue[i]]);
            ++*flipped;
        }
}

static bool is_consistent(const struct mesh_edges *edges)
{
    int directions;
    for (size_t v = 0; v < edges->n_vertices; v++)
        for (size_t i = edges->begin[v], end; i < edges->begin[v + 1]; i = end) {
            end = mesh_edge_end(edges, v, i, &directions);
            if (end == i + 2 && directions != 0)
                return false;
        }
    return true;
}

status mesh_orient_consistently(struct mesh *mesh, size_t *flipped)
{
    status st = OK;
    struct mesh_edges edges = {0};
    struct patches p = {.mesh = mesh, .edges = &edges};
    *flipped = 0;
    TRY(mesh_edges_create(mesh, &edges));
    if (is_consistent(&edges))
        goto done;
    TRY(memory_alloc(mesh->n_triangles, sizeof *p.state, "a mesh's faces", &p.state));
    TRY(memory_alloc(mesh->n_triangles, sizeof *p.queue, "a mesh's faces", &p.queue));
    for (size_t t = 0; t < mesh->n_triangles; t++) {
        if (p.state[t] != UNSEEN)
            continue;
        p.n_queue = 0;
        p.state[t] = KEPT;
        p.queue[p.n_queue++] = (uint32_t)t;
        for (size_t i = 0; i < p.n_queue; i++)
            visit(&p, p.queue[i]);
        flip_patch(mesh, &p, flipped);
    }
done:
    mesh_edges_free(&edges);
    free(p.state);
    free(p.queue);
    return st;
}

/* ---- outwards */

/* Triangles of a part whose winding number is computed; of all parts together, before it is one a part. */
enum { SAMPLES = 16, MAX_SAMPLES = 100000 };

struct part {
    double volume, area;
    size_t n; /* triangles */
    bool open, flipped;
};

struct parts {
    size_t n;
    struct part *part;
    uint32_t *of; /* [n_vertices]: the vertex's part */
};

static uint32_t root_of(uint32_t *parent, uint32_t i)
{
    while (parent[i] != i)
        i = parent[i] = parent[parent[i]];
    return i;
}

/* Parts are the connected components of vertices (union-find). */
static status find_parts(const struct mesh *mesh, struct parts *out)
{
    status st = OK;
    uint32_t *number = NULL;
    *out = (struct parts){0};
    TRY(memory_alloc(mesh->n_vertices, sizeof *out->of, "a mesh's parts", &out->of));
    TRY(memory_alloc(mesh->n_vertices, sizeof *number, "a mesh's parts", &number));
    for (size_t v = 0; v < mesh->n_vertices; v++)
        out->of[v] = (uint32_t)v;
    for (size_t t = 0; t < mesh->n_triangles; t++)
        for (int k = 1; k < 3; k++) {
            const uint32_t a = root_of(out->of, mesh->triangle[t][0]),
                           b = root_of(out->of, mesh->triangle[t][k]);
            out->of[a > b ? a : b] = a > b ? b : a; /* the root is the part's lowest vertex */
        }
    for (size_t v = 0; v < mesh->n_vertices; v++)
        out->of[v] = root_of(out->of, (uint32_t)v);
    for (size_t v = 0; v < mesh->n_vertices; v++)
        if (out->of[v] == v)
            number[v] = (uint32_t)out->n++;
    for (size_t v = 0; v < mesh->n_vertices; v++)
        out->of[v] = number[out->of[v]];
    TRY(memory_alloc(out->n, sizeof *out->part, "a mesh's parts", &out->part));
done:
    free(number);
    return st;
}

/* Volumes are integrated about the mesh's centroid, from where the missing volume of a hole is small. */
static void measure(const struct mesh *mesh, const struct mesh_open *open, struct parts *p)
{
    double middle[3] = {0};
    for (size_t v = 0; v < mesh->n_vertices; v++)
        for (int a = 0; a < 3; a++)
            middle[a] += mesh->vertex[v][a] / (double)mesh->n_vertices;
    for (size_t t = 0; t < mesh->n_triangles; t++) {
        struct part *part = &p->part[p->of[mesh->triangle[t][0]]];
        double n[3];
        mesh_triangle_normal(mesh, t, n);
        part->n++;
        part->area += sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
        for (int a = 0; a < 3; a++)
            part->volume += n[a] / 3 * (mesh->vertex[mesh->triangle[t][0]][a] - middle[a]);
    }
    for (size_t i = 0; i < open->n; i++)
        p->part[p->of[open->edge[i][0]]].open = true;
}

/* Is the part's volume negative, by more than rounding? The volume of an open part does not tell. */
static bool is_negative(const struct part *p)
{
    return !p->open && p->volume < -1e-9 * p->area * sqrt(p->area);
}

/* The winding number of all other parts at triangle t of a part that is inside out. The part's own winding number is 0 on one side of t
 * and -1 on the other, -0.5 on average. */
static double winding_of_others(const struct mesh *mesh, const struct winding *w, size_t t)
{
    double n[3], x[2][3], sum = 0;
    mesh_triangle_normal(mesh, t, n);
    const double area = mesh_triangle_area(mesh, t), step = 1e-3 * sqrt(area);
    for (int side = 0; side < 2; side++) {
        for (int a = 0; a < 3; a++) {
            x[side][a] = (side ? -step : step) * (area > 0 ? n[a] / area : 0);
            for (int k = 0; k < 3; k++)
                x[side][a] += mesh->vertex[mesh->triangle[t][k]][a] / 3;
        }
        sum += (double)winding_number(w, x[side]) / 2;
    }
    return sum + 0.5;
}

/* A part of negative volume is a cavity if some of its triangles, evenly spread, are all inside other parts; otherwise it is flipped. */
static status flip_unless_cavity(const struct mesh *mesh, struct parts *p, size_t n_negative)
{
    status st = OK;
    struct winding *w = NULL;
    size_t *seen = NULL;
    const size_t samples = n_negative * SAMPLES <= MAX_SAMPLES ? SAMPLES : 1;
    TRY(memory_alloc(p->n, sizeof *seen, "a mesh's parts", &seen));
    TRY(winding_create((const double(*)[3])mesh->vertex, mesh->n_vertices,
                       (const uint32_t(*)[3])mesh->triangle, mesh->n_triangles, 2, &w));
    for (size_t t = 0; t < mesh->n_triangles; t++) {
        struct part *part = &p->part[p->of[mesh->triangle[t][0]]];
        const size_t i = seen[part - p->part]++, step = (part->n + samples - 1) / samples;
        if (is_negative(part) && !part->flipped && i % step == 0)
            part->flipped = winding_of_others(mesh, w, t) < 0.5;
    }
done:
    free(seen);
    winding_destroy(&w);
    return st;
}

status mesh_orient_outwards(struct mesh *mesh, const struct mesh_open *open, size_t *flipped)
{
    status st = OK;
    struct parts p = {0};
    double volume = 0;
    size_t n_negative = 0;
    *flipped = 0;
    TRY(find_parts(mesh, &p));
    measure(mesh, open, &p);
    for (size_t i = 0; i < p.n; i++)
        volume += p.part[i].volume;
    for (size_t t = 0; volume < 0 && t < mesh->n_triangles; t++)
        flip(mesh->triangle[t]);
    for (size_t i = 0; i < p.n; i++) {
        p.part[i].volume *= volume < 0 ? -1 : 1;
        n_negative += is_negative(&p.part[i]) ? 1 : 0;
    }
    if (n_negative > 0)
        TRY(flip_unless_cavity(mesh, &p, n_negative));
    for (size_t t = 0; t < mesh->n_triangles; t++)
        if (p.part[p.of[mesh->triangle[t][0]]].flipped)
            flip(mesh->triangle[t]);
    for (size_t i = 0; i < p.n; i++)
        *flipped += p.part[i].flipped != (volume < 0);
done:
    free(p.part);
    free(p.of);
    return st;
}
