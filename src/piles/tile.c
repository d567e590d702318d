#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "base/random.h"
#include "base/vector.h"
#include "piles/piles.h"

/* Share of the tile's volume in spheres; random sequential placing saturates at 0.38. */
#define PACKING 0.30

/* Edges and corners are rounded where two faces are closer to each other than this, in radii. */
#define ROUNDING 0.35

enum { TRIALS = 200000, PLANES = 64, CHIPS = 9, CONTACT_TRIALS = 24 };

/* Half-space n . p <= d around a rock's centre. */
struct plane {
    double n[3], d;
    size_t other; /* the rock beyond it */
    double shift[3];
};

struct cell {
    size_t n;
    struct plane plane[PLANES];
};

static double chance(uint32_t seed, uint32_t a, uint32_t b, uint32_t what)
{
    return (double)random_float(random_hash(seed ^ RANDOM_PILES, a, b, what));
}

/* Uniform on the sphere. */
static void direction(uint32_t seed, uint32_t a, uint32_t b, double out[3])
{
    double z = 2 * chance(seed, a, b, 1) - 1, angle = 2 * M_PI * chance(seed, a, b, 2), r = sqrt(1 - z * z);
    out[0] = r * cos(angle);
    out[1] = r * sin(angle);
    out[2] = z;
}

/* ---- centres */

/* The shortest vector from a to b in the periodic tile. */
static void shortest(const struct pile_tile *t, const double a[3], const double b[3], double out[3])
{
    for (int k = 0; k < 3; k++) {
        out[k] = b[k] - a[k];
        out[k] -= t->side * round(out[k] / t->side);
    }
}

static void scatter(struct pile_tile *t, const struct pile_options *o)
{
    for (uint32_t trial = 0; trial < TRIALS && t->n < o->rocks; trial++) {
        double at[3], d[3];
        bool clear = true;
        for (uint32_t k = 0; k < 3; k++)
            at[k] = t->side * chance(o->seed, trial, k, 3);
        for (size_t i = 0; i < t->n && clear; i++) {
            shortest(t, at, t->rock[i].center, d);
            clear = dot3(d, d) >= 4 * o->radius * o->radius;
        }
        if (clear)
            memcpy(t->rock[t->n++].center, at, sizeof at);
    }
}

/* ---- cells */

static int by_distance(const void *a, const void *b)
{
    const struct plane *x = a, *y = b;
    if (x->d != y->d)
        return x->d < y->d ? -1 : 1;
    return (x->other > y->other) - (x->other < y->other);
}

/* The closest bisecting planes around rock i, many more than a cell has faces. */
static status find_cell(const struct pile_tile *t, size_t i, struct cell *c)
{
    status st = OK;
    struct plane *all = NULL;
    size_t n = 0;
    TRY(memory_alloc(27 * t->n, sizeof *all, "rocks", &all));
    for (size_t j = 0; j < t->n; j++)
        for (int image = 0; image < 27; image++) {
            struct plane p = {.other = j};
            const int offset[3] = {image % 3 - 1, image / 3 % 3 - 1, image / 9 - 1};
            for (int k = 0; k < 3; k++)
                p.shift[k] = t->rock[j].center[k] - t->rock[i].center[k] + offset[k] * t->side;
            double length = sqrt(dot3(p.shift, p.shift));
            if (!(length > 0))
                continue;
            for (int k = 0; k < 3; k++)
                p.n[k] = p.shift[k] / length;
            p.d = length / 2;
            all[n++] = p;
        }
    qsort(all, n, sizeof *all, by_distance);
    c->n = n < PLANES ? n : PLANES;
    memcpy(c->plane, all, c->n * sizeof *all);
done:
    free(all);
    return st;
}

/* The depth of p below the closest of the planes, except plane `except`. */
static double depth_at(const struct cell *c, const double p[3], size_t except)
{
    double depth = HUGE_VAL;
    for (size_t k = 0; k < c->n; k++)
        if (k != except)
            depth = fmin(depth, c->plane[k].d - dot3(c->plane[k].n, p));
    return depth;
}

/* ---- contacts */

static status add_contact(struct pile_rock *r, const struct pile_contact *contact)
{
    status st =
        memory_grow(&r->contact, &r->contacts_capacity, r->n_contacts + 1, sizeof *r->contact, "rocks");
    if (st == OK)
        r->contact[r->n_contacts++] = *contact;
    return st;
}

/* The face of the neighbouring cell that coincides with face f of rock i. */
static size_t same_face(const struct cell *beyond, size_t i, const struct plane *f)
{
    for (size_t k = 0; k < beyond->n; k++) {
        const struct plane *p = &beyond->plane[k];
        const double d[3] = {p->shift[0] + f->shift[0], p->shift[1] + f->shift[1], p->shift[2] + f->shift[2]};
        if (p->other == i && dot3(d, d) < 1e-12 * dot3(f->shift, f->shift))
            return k;
    }
    return SIZE_MAX;
}

/* A random point of the face outside of its rounded edges; false: the face is too small. */
static bool point_on_face(const struct cell *cell, size_t i, size_t face, double radius, uint32_t seed,
                          uint32_t what, double out[3])
{
    const struct cell *c = &cell[i], *beyond = &cell[c->plane[face].other];
    const struct plane *f = &c->plane[face];
    double size = 1.2 * radius;
    for (uint32_t trial = 0; trial < CONTACT_TRIALS; trial++, size *= 0.9) {
        double away[3];
        direction(seed, what, trial, away);
        double length = size * sqrt(chance(seed, what, trial, 4)), out_of = dot3(away, f->n);
        for (int k = 0; k < 3; k++)
            out[k] = f->d * f->n[k] + length * (away[k] - out_of * f->n[k]);
        const double there[3] = {out[0] - f->shift[0], out[1] - f->shift[1], out[2] - f->shift[2]};
        double clear = ROUNDING * radius * 1.01;
        if (depth_at(c, out, face) > clear && depth_at(beyond, there, same_face(beyond, i, f)) > clear)
            return true;
    }
    return false;
}

/* Each face is visited once: from the rock with the lower number, or, between a rock and its own image, from one side. */
static status find_contacts(struct pile_tile *t, const struct pile_options *o, size_t i,
                            const struct cell *cell)
{
    status st = OK;
    const struct cell *c = &cell[i];
    for (size_t face = 0; face < c->n; face++) {
        const struct plane *f = &c->plane[face];
        bool own_side =
            i < f->other || (i == f->other && (f->shift[0] > 0 || (f->shift[0] == 0 && f->shift[1] > 0) ||
                                               (f->shift[0] == 0 && f->shift[1] == 0 && f->shift[2] > 0)));
        for (size_t k = 0; k < o->contacts && own_side; k++) {
            struct pile_contact here = {.other = f->other}, there = {.other = i};
            uint32_t what = (uint32_t)((i * PLANES + face) * 8 + k);
            if (!point_on_face(cell, i, face, o->radius, o->seed, what, here.at))
                break;
            for (int a = 0; a < 3; a++) {
                here.shift[a] = f->shift[a];
                there.shift[a] = -f->shift[a];
                there.at[a] = here.at[a] - f->shift[a];
            }
            TRY(add_contact(&t->rock[i], &here));
            TRY(add_contact(&t->rock[f->other], &there));
        }
    }
done:
    return st;
}

/* ---- the eroded rock */

struct worn {
    const struct pile_rock *rock;
    const struct cell *cell;
    struct plane chip[CHIPS]; /* corners that have broken off, away from the contacts */
    size_t n_chips;
    double radius, erosion;
};

static double smooth_min(double a, double b, double width)
{
    double h = fmax(width - fabs(a - b), 0) / width;
    return fmin(a, b) - 0.25 * width * h * h;
}

/* Positive inside the rock: the depth of p in its cell minus the erosion there. */
static double inside(const struct worn *w, const double p[3])
{
    double width = ROUNDING * w->radius, depth = 4 * w->radius, resistance = 0;
    double own[PLANES], rounded = 0;
    for (size_t k = 0; k < w->cell->n; k++) {
        own[k] = w->cell->plane[k].d - dot3(w->cell->plane[k].n, p);
        depth = fmin(depth, own[k]);
    }
    /* Each face that is almost as close as the closest rounds their common edge; the closest one is also counted, hence the minus one. */
    for (size_t k = 0; k < w->cell->n; k++) {
        double h = 1 - (own[k] - depth) / width;
        rounded += h > 0 ? h * h : 0;
    }
    depth -= 0.25 * width * (rounded - 1);
    for (size_t k = 0; k < w->rock->n_contacts; k++) {
        const double *c = w->rock->contact[k].at, d[3] = {p[0] - c[0], p[1] - c[1], p[2] - c[2]};
        resistance = fmax(resistance, exp(-dot3(d, d) / (w->radius * w->radius)));
    }
    double worn = depth - w->erosion * w->radius * (1 - resistance);
    for (size_t k = 0; k < w->n_chips; k++)
        worn = smooth_min(worn, w->chip[k].d - dot3(w->chip[k].n, p), 0.15 * width);
    return worn;
}

/* The distance at which the ray from the centre along u leaves the rock. */
static double leave(const struct worn *w, const double u[3])
{
    double low = 0, high = 0, step = 0.1 * w->radius;
    for (int i = 0; i < 100; i++) {
        high += step;
        const double p[3] = {high * u[0], high * u[1], high * u[2]};
        if (inside(w, p) <= 0)
            break;
        low = high;
    }
    for (int i = 0; i < 24; i++) {
        double middle = 0.5 * (low + high);
        const double p[3] = {middle * u[0], middle * u[1], middle * u[2]};
        if (inside(w, p) > 0)
            low = middle;
        else
            high = middle;
    }
    return low;
}

static void chip(struct worn *w, uint32_t seed, uint32_t rock)
{
    for (uint32_t k = 0; k < CHIPS; k++) {
        struct plane p = {0};
        direction(seed, rock, 1000 + k, p.n);
        p.d = leave(w, p.n) * (0.70 + 0.22 * chance(seed, rock, 2000 + k, 5));
        bool clear = true;
        for (size_t c = 0; c < w->rock->n_contacts; c++)
            clear &= p.d - dot3(p.n, w->rock->contact[c].at) > 0.06 * w->radius;
        if (clear)
            w->chip[w->n_chips++] = p;
    }
}

/* Keeps the planes that any ray of the mesh meets or is rounded by. */
static void trim(struct cell *c, const double (*u)[3], size_t n, double radius)
{
    bool used[PLANES] = {false};
    for (size_t v = 0; v < n; v++) {
        double nearest = HUGE_VAL;
        for (size_t k = 0; k < c->n; k++) {
            double slope = dot3(c->plane[k].n, u[v]);
            nearest = fmin(nearest, slope > 0 ? c->plane[k].d / slope : HUGE_VAL);
        }
        const double p[3] = {nearest * u[v][0], nearest * u[v][1], nearest * u[v][2]};
        for (size_t k = 0; k < c->n; k++)
            used[k] |= c->plane[k].d - dot3(c->plane[k].n, p) < 2 * ROUNDING * radius;
    }
    size_t kept = 0;
    for (size_t k = 0; k < c->n; k++)
        if (used[k])
            c->plane[kept++] = c->plane[k];
    c->n = kept;
}

/* Moves the mesh directions closest to contacts onto them, so that the mesh passes through the contacts. */
static void aim(const struct pile_rock *r, const double (*sphere)[3], double (*u)[3], size_t n)
{
    for (size_t c = 0; c < r->n_contacts; c++) {
        const double *at = r->contact[c].at;
        double length = sqrt(dot3(at, at)), best = -HUGE_VAL;
        size_t nearest = 0;
        for (size_t v = 0; v < n; v++)
            /* A direction that has been moved belongs to its contact. */
            if (dot3(u[v], at) > best && memcmp(u[v], sphere[v], sizeof u[v]) == 0) {
                best = dot3(u[v], at);
                nearest = v;
            }
        for (int a = 0; a < 3; a++)
            u[nearest][a] = at[a] / length;
    }
}

static status make_mesh(struct pile_tile *t, const struct pile_options *o, size_t i, struct cell *cell,
                        const double (*sphere)[3], size_t n)
{
    status st = OK;
    struct pile_rock *r = &t->rock[i];
    struct worn w = {.rock = r, .cell = cell, .radius = o->radius, .erosion = o->erosion};
    double(*u)[3] = NULL;
    TRY(memory_alloc(n, sizeof *u, "rocks", &u));
    memcpy(u, sphere, n * sizeof *u);
    trim(cell, sphere, n, o->radius);
    aim(r, sphere, u, n);
    chip(&w, o->seed, (uint32_t)i);
    TRY(memory_alloc(3 * n, sizeof *r->vertex, "rocks", &r->vertex));
    TRY(memory_alloc(3 * n, sizeof *r->normal, "rocks", &r->normal));
    r->n_vertices = n;
    for (size_t v = 0; v < n; v++) {
        double d = leave(&w, u[v]), p[3], normal[3], step = 1e-3 * o->radius;
        r->reach = fmax(r->reach, d);
        for (int a = 0; a < 3; a++) {
            p[a] = d * u[v][a];
            r->vertex[3 * v + (size_t)a] = (float)p[a];
        }
        for (int a = 0; a < 3; a++) {
            double q[2][3] = {{p[0], p[1], p[2]}, {p[0], p[1], p[2]}};
            q[0][a] -= step;
            q[1][a] += step;
            normal[a] = inside(&w, q[0]) - inside(&w, q[1]);
        }
        double length = sqrt(dot3(normal, normal));
        for (int a = 0; a < 3; a++)
            r->normal[3 * v + (size_t)a] = (float)(length > 0 ? normal[a] / length : u[v][a]);
    }
done:
    free(u);
    return st;
}

/* ---- a sphere of triangles */

static size_t middle_of(double (*u)[3], size_t *n, uint32_t (*edge)[3], size_t *n_edges, uint32_t a,
                        uint32_t b)
{
    uint32_t lo = a < b ? a : b, hi = a < b ? b : a;
    for (size_t e = *n_edges; e-- > 0;)
        if (edge[e][0] == lo && edge[e][1] == hi)
            return edge[e][2];
    double m[3], length;
    for (int k = 0; k < 3; k++)
        m[k] = u[a][k] + u[b][k];
    length = sqrt(dot3(m, m));
    for (int k = 0; k < 3; k++)
        u[*n][k] = m[k] / length;
    edge[*n_edges][0] = lo;
    edge[*n_edges][1] = hi;
    edge[(*n_edges)++][2] = (uint32_t)*n;
    return (*n)++;
}

/* An icosahedron, `detail` times subdivided into four. */
static status make_sphere(int detail, double (**out)[3], size_t *n, uint32_t **triangle, size_t *n_triangles)
{
    static const uint32_t faces[20][3] = {{0, 11, 5}, {0, 5, 1},  {0, 1, 7},   {0, 7, 10}, {0, 10, 11},
                                          {1, 5, 9},  {5, 11, 4}, {11, 10, 2}, {10, 7, 6}, {7, 1, 8},
                                          {3, 9, 4},  {3, 4, 2},  {3, 2, 6},   {3, 6, 8},  {3, 8, 9},
                                          {4, 9, 5},  {2, 4, 11}, {6, 2, 10},  {8, 6, 7},  {9, 8, 1}};
    status st = OK;
    const double g = (1 + sqrt(5)) / 2, unit = 1 / sqrt(1 + g * g);
    const double corner[12][3] = {{-1, g, 0},  {1, g, 0},  {-1, -g, 0}, {1, -g, 0}, {0, -1, g},  {0, 1, g},
                                  {0, -1, -g}, {0, 1, -g}, {g, 0, -1},  {g, 0, 1},  {-g, 0, -1}, {-g, 0, 1}};
    size_t most = (size_t)20 << 2 * detail;
    double(*u)[3] = NULL;
    uint32_t *t = NULL, *finer = NULL, (*edge)[3] = NULL;
    TRY(memory_alloc(most / 2 + 2, sizeof *u, "rocks", &u));
    TRY(memory_alloc(3 * most, sizeof *t, "rocks", &t));
    TRY(memory_alloc(3 * most, sizeof *finer, "rocks", &finer));
    TRY(memory_alloc(3 * most / 2, sizeof *edge, "rocks", &edge));
    for (*n = 0; *n < 12; (*n)++)
        for (int k = 0; k < 3; k++)
            u[*n][k] = corner[*n][k] * unit;
    memcpy(t, faces, sizeof faces);
    *n_triangles = 20;
    for (int level = 0; level < detail; level++) {
        size_t n_edges = 0, made = 0;
        for (size_t f = 0; f < *n_triangles; f++) {
            uint32_t a = t[3 * f], b = t[3 * f + 1], c = t[3 * f + 2];
            uint32_t ab = (uint32_t)middle_of(u, n, edge, &n_edges, a, b);
            uint32_t bc = (uint32_t)middle_of(u, n, edge, &n_edges, b, c);
            uint32_t ca = (uint32_t)middle_of(u, n, edge, &n_edges, c, a);
            const uint32_t four[12] = {a, ab, ca, b, bc, ab, c, ca, bc, ab, bc, ca};
            memcpy(finer + 3 * made, four, sizeof four);
            made += 4;
        }
        uint32_t *old = t;
        t = finer;
        finer = old;
        *n_triangles = made;
    }
    *out = u;
    *triangle = t;
    u = NULL;
    t = NULL;
done:
    free(u);
    free(t);
    free(finer);
    free(edge);
    return st;
}

/* ---- the tile */

status pile_tile_create(const struct pile_options *o, struct pile_tile *out)
{
    status st = OK;
    struct pile_tile t = {.radius = o->radius};
    struct cell *cell = NULL;
    double(*sphere)[3] = NULL;
    size_t n = 0;
    t.side = o->radius * cbrt((double)o->rocks * 4.0 / 3 * M_PI / PACKING);
    TRY(memory_alloc(o->rocks, sizeof *t.rock, "rocks", &t.rock));
    scatter(&t, o);
    TRY(memory_alloc(t.n, sizeof *cell, "rocks", &cell));
    for (size_t i = 0; i < t.n; i++)
        TRY(find_cell(&t, i, &cell[i]));
    for (size_t i = 0; i < t.n; i++)
        TRY(find_contacts(&t, o, i, cell));
    TRY(make_sphere(o->detail, &sphere, &n, &t.triangle, &t.n_triangles));
    for (size_t i = 0; i < t.n; i++) {
        TRY(make_mesh(&t, o, i, &cell[i], (const double(*)[3])sphere, n));
        t.reach = fmax(t.reach, t.rock[i].reach);
    }
    *out = t;
    t = (struct pile_tile){0};
done:
    pile_tile_destroy(&t);
    free(cell);
    free(sphere);
    return st;
}

void pile_tile_destroy(struct pile_tile *t)
{
    for (size_t i = 0; t->rock && i < t->n; i++) {
        free(t->rock[i].contact);
        free(t->rock[i].vertex);
        free(t->rock[i].normal);
    }
    free(t->rock);
    free(t->triangle);
    *t = (struct pile_tile){0};
}
