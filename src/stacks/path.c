#include "stacks/path.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "base/vector.h"

enum { MOST_PIECES = 1 << 20, MOST_LISTED = 1 << 28 };

/* ---- small vectors */

static double normalize(double v[3])
{
    double length = sqrt(dot3(v, v));
    for (int a = 0; a < 3 && length > 0; a++)
        v[a] /= length;
    return length;
}

/* Catmull and Rom's cubic from p1 (t = 0) to p2, and its derivative. */
static double cubic(double p0, double p1, double p2, double p3, double t)
{
    return p1 + 0.5 * t * (p2 - p0 + t * (2 * p0 - 5 * p1 + 4 * p2 - p3 + t * (3 * (p1 - p2) + p3 - p0)));
}

static double cubic_slope(double p0, double p1, double p2, double p3, double t)
{
    return 0.5 * (p2 - p0 + t * (2 * (2 * p0 - 5 * p1 + 4 * p2 - p3) + 3 * t * (3 * (p1 - p2) + p3 - p0)));
}

/* ---- profiles */

static void curve_of(const double (*control)[2], size_t n, double out[PROFILE_POINTS][2])
{
    for (int k = 0; k < PROFILE_POINTS; k++) {
        double u = (double)k / PROFILE_POINTS * (double)n;
        size_t i = (size_t)u;
        for (int a = 0; a < 2; a++)
            out[k][a] = cubic(control[(i + n - 1) % n][a], control[i][a], control[(i + 1) % n][a],
                              control[(i + 2) % n][a], u - (double)i);
    }
}

static void make_profiles(struct path *p, const struct job_operation *op)
{
    double ends[2][PROFILE_POINTS][2];
    p->round = op->n_profile == 0;
    for (int a = 0; a < 2; a++) {
        p->lo[a] = -p->round;
        p->hi[a] = p->round;
    }
    if (p->round)
        return;
    curve_of((const double(*)[2])op->profile, op->n_profile, ends[0]);
    curve_of((const double(*)[2])(op->n_end_profile ? op->end_profile : op->profile), op->n_profile, ends[1]);
    for (int s = 0; s < PROFILE_STEPS; s++) {
        double at[PROFILE_POINTS][2], share = (double)s / (PROFILE_STEPS - 1);
        for (int k = 0; k < PROFILE_POINTS; k++)
            for (int a = 0; a < 2; a++) {
                at[k][a] = ends[0][k][a] + share * (ends[1][k][a] - ends[0][k][a]);
                p->lo[a] = fmin(p->lo[a], at[k][a]);
                p->hi[a] = fmax(p->hi[a], at[k][a]);
            }
        for (int k = 0; k < PROFILE_POINTS; k++) {
            const double *from = at[k], *to = at[(k + 1) % PROFILE_POINTS];
            struct profile_edge e = {from[0], from[1], to[0] - from[0], to[1] - from[1], 0, 0};
            double square = e.ex * e.ex + e.ey * e.ey;
            e.inverse = square > 0 ? 1 / square : 0;
            e.slope = e.ey != 0 ? e.ex / e.ey : 0;
            p->profile[s][k] = e;
        }
    }
}

/* Signed distance to a closed polygon, negative inside, whatever its shape (even-odd). */
static double polygon_distance(const struct profile_edge *edge, double x, double y)
{
    double nearest = HUGE_VAL;
    int crossed = 0;
    for (int i = 0; i < PROFILE_POINTS; i++) {
        const struct profile_edge e = edge[i];
        double wx = x - e.x, wy = y - e.y, t = (wx * e.ex + wy * e.ey) * e.inverse;
        t = t < 0 ? 0 : t > 1 ? 1 : t;
        double dx = wx - t * e.ex, dy = wy - t * e.ey, away = dx * dx + dy * dy;
        nearest = away < nearest ? away : nearest;
        crossed ^= ((wy < 0) != (wy < e.ey)) & (wx < e.slope * wy);
    }
    return crossed ? -sqrt(nearest) : sqrt(nearest);
}

/* ---- the graph */

struct graph {
    const struct job_operation *op;
    size_t n_arcs;
    size_t *into, *from; /* by point: an arc that ends, begins there, plus 1; 0: none */
    bool *joined;
    double *distance; /* m from the first point */
    double longest;
};

static void arc_of(const struct graph *g, size_t arc, size_t end[2])
{
    for (size_t e = 0; e < 2; e++)
        end[e] = g->op->n_arcs ? (size_t)g->op->arcs[arc][e] : arc + e;
}

static double arc_length(const struct graph *g, size_t arc)
{
    size_t end[2];
    arc_of(g, arc, end);
    const double *a = g->op->points_m[end[0]], *b = g->op->points_m[end[1]];
    const double d[3] = {b[0] - a[0], b[1] - a[1], b[2] - a[2]};
    return sqrt(dot3(d, d));
}

/* Along the arcs, however they are listed: a few passes settle what is listed in any sensible order. */
static void measure(struct graph *g)
{
    enum { PASSES = 64 };
    bool changed = true;
    for (int pass = 0; changed && pass < PASSES; pass++) {
        changed = false;
        for (size_t k = 0; k < g->n_arcs; k++) {
            size_t arc = pass % 2 ? g->n_arcs - 1 - k : k, end[2];
            double length = arc_length(g, arc);
            arc_of(g, arc, end);
            for (size_t e = 0; e < 2; e++)
                if (g->distance[end[e]] + length < g->distance[end[1 - e]]) {
                    g->distance[end[1 - e]] = g->distance[end[e]] + length;
                    changed = true;
                }
        }
    }
    for (size_t p = 0; p < g->op->n_points_m; p++) {
        if (g->distance[p] == HUGE_VAL)
            g->distance[p] = 0;
        g->longest = fmax(g->longest, g->distance[p]);
    }
}

static status graph_create(const struct job_operation *op, struct graph *g)
{
    status st = OK;
    size_t n = op->n_points_m;
    *g = (struct graph){.op = op, .n_arcs = op->n_arcs ? op->n_arcs : n - 1};
    TRY(memory_alloc(n, sizeof *g->into, "a path", &g->into));
    TRY(memory_alloc(n, sizeof *g->from, "a path", &g->from));
    TRY(memory_alloc(n, sizeof *g->joined, "a path", &g->joined));
    TRY(memory_alloc(n, sizeof *g->distance, "a path", &g->distance));
    for (size_t p = 0; p < n; p++)
        g->distance[p] = p ? HUGE_VAL : 0;
    for (size_t arc = 0; arc < g->n_arcs; arc++) {
        size_t end[2];
        arc_of(g, arc, end);
        g->joined[end[0]] = g->joined[end[1]] = true;
        if (!g->from[end[0]])
            g->from[end[0]] = arc + 1;
        if (!g->into[end[1]])
            g->into[end[1]] = arc + 1;
    }
    measure(g);
done:
    return st;
}

static void graph_free(struct graph *g)
{
    free(g->into);
    free(g->from);
    free(g->joined);
    free(g->distance);
}

/* ---- pieces */

struct maker {
    const struct graph *graph;
    const struct surface *surface; /* NULL: not projected */
    struct surface smooth;         /* for normals: over about the tool's own width */
    double side[3];                /* the last one: where the path is vertical it goes on */
    double from, to;
    struct path *path;
};

/* Turns an end's frame: its direction is there, its up is what it leans on. */
static void turn(struct maker *m, struct path_end *e, const double up[3])
{
    if (!(normalize(e->along) > 0))
        e->along[0] = 1;
    cross3(e->along, up, e->side);
    double across = sqrt(dot3(e->side, e->side));
    if (across < 0.05)
        memcpy(e->side, m->side, sizeof e->side);
    double out = dot3(e->side, e->along);
    for (int a = 0; a < 3; a++)
        e->side[a] -= out * e->along[a];
    if (!(normalize(e->side) > 0))
        cross3(e->along, (const double[]){0.6, 0.8, 0}, e->side);
    normalize(e->side);
    cross3(e->side, e->along, e->up);
    memcpy(m->side, e->side, sizeof e->side);
}

static status place(struct maker *m, struct path_end *e)
{
    status st = OK;
    double up[3] = {0, 0, 1};
    if (m->surface) {
        bool found;
        TRY(surface_project(m->surface, e->at, &found));
        m->smooth.sigma =
            fmin(fmax(m->surface->sigma, 0.7 * e->radius), SURFACE_WIDEST * m->surface->stacks->cell);
        surface_normal(&m->smooth, e->at, up);
    }
    turn(m, e, up);
done:
    return st;
}

static status add_piece(struct path *p, const struct path_piece *piece)
{
    if (p->n >= MOST_PIECES)
        return fail(E_USAGE, "more than %d pieces of path, each 0.3 radii long: fewer points, or wider",
                    MOST_PIECES);
    status st = memory_grow(&p->piece, &p->capacity, p->n + 1, sizeof *p->piece, "a path");
    if (st == OK)
        p->piece[p->n++] = *piece;
    return st;
}

static status add_arc(struct maker *m, size_t arc)
{
    enum { MOST = 4096 };
    status st = OK;
    const struct graph *g = m->graph;
    size_t end[2], other[2];
    arc_of(g, arc, end);
    /* The points before and after; where there are none, the arc's own line goes on. */
    const double *p[4], (*at)[4] = (const double(*)[4])g->op->points_m;
    double before[4], after[4];
    p[1] = at[end[0]];
    p[2] = at[end[1]];
    for (int a = 0; a < 4; a++) {
        before[a] = 2 * p[1][a] - p[2][a];
        after[a] = 2 * p[2][a] - p[1][a];
    }
    p[0] = before;
    p[3] = after;
    if (g->into[end[0]]) {
        arc_of(g, g->into[end[0]] - 1, other);
        p[0] = at[other[0]];
    }
    if (g->from[end[1]]) {
        arc_of(g, g->from[end[1]] - 1, other);
        p[3] = at[other[1]];
    }
    double least = fmin(p[1][3], p[2][3]), length = arc_length(g, arc);
    int n = (int)fmin(fmax(ceil(length / (0.3 * least)), 1), MOST);
    struct path_piece piece = {0};
    for (int k = 0; k <= n; k++) {
        double t = (double)k / n;
        struct path_end e = {0};
        for (int a = 0; a < 3; a++) {
            e.at[a] = cubic(p[0][a], p[1][a], p[2][a], p[3][a], t);
            e.along[a] = cubic_slope(p[0][a], p[1][a], p[2][a], p[3][a], t);
        }
        e.radius = fmax(cubic(p[0][3], p[1][3], p[2][3], p[3][3], t), 0.5 * least);
        double far = g->distance[end[0]] + t * (g->distance[end[1]] - g->distance[end[0]]);
        e.share = g->longest > 0 ? far / g->longest : 0;
        TRY(place(m, &e));
        piece.end[0] = piece.end[1];
        piece.end[1] = e;
        double share = 0.5 * (piece.end[0].share + e.share);
        piece.first = k == 1 && !g->into[end[0]];
        piece.last = k == n && !g->from[end[1]];
        if (k > 0 && share >= m->from && (share < m->to || m->to >= 1))
            TRY(add_piece(m->path, &piece));
    }
done:
    return st;
}

static status add_point(struct maker *m, size_t point)
{
    const double *at = m->graph->op->points_m[point];
    struct path_end e = {.at = {at[0], at[1], at[2]}, .radius = at[3], .along = {1, 0, 0}};
    status st = place(m, &e);
    if (st == OK && (m->from <= 0))
        st = add_piece(m->path, &(struct path_piece){.end = {e, e}});
    return st;
}

/* ---- which pieces reach which stacks */

static void find_box(const struct path *p, double reach, struct path_piece *piece)
{
    for (int a = 0; a < 3; a++) {
        piece->lo[a] = HUGE_VAL;
        piece->hi[a] = -HUGE_VAL;
    }
    for (int corner = 0; corner < 8; corner++) {
        const struct path_end *e = &piece->end[corner & 1];
        double x = corner & 2 ? p->hi[0] + reach : p->lo[0] - reach;
        double y = corner & 4 ? p->hi[1] + reach : p->lo[1] - reach;
        for (int a = 0; a < 3; a++) {
            double at = e->at[a] + e->radius * (p->round ? 0 : x * e->side[a] + y * e->up[a]);
            double round = p->round ? (1 + reach) * e->radius : reach * e->radius;
            piece->lo[a] = fmin(piece->lo[a], at - round);
            piece->hi[a] = fmax(piece->hi[a], at + round);
        }
    }
}

static void piece_stacks(const struct stacks *s, const struct path_piece *piece, int lo[2], int hi[2])
{
    for (int a = 0; a < 2; a++) {
        lo[a] = (int)fmin(fmax(floor(piece->lo[a] / s->cell), 0), s->n[a]);
        hi[a] = (int)fmin(fmax(floor(piece->hi[a] / s->cell), -1), s->n[a] - 1);
    }
}

static status sort_into_blocks(struct path *p, const struct stacks *s)
{
    status st = OK;
    for (int a = 0; a < 2; a++)
        p->blocks[a] = (s->n[a] + PATH_BLOCK - 1) / PATH_BLOCK;
    size_t n = (size_t)p->blocks[0] * (size_t)p->blocks[1];
    TRY(memory_alloc(n + 2, sizeof *p->first, "a path", &p->first));
    size_t listed = 0;
    for (int pass = 0; pass < 2; pass++) {
        for (size_t k = 0; k < p->n; k++) {
            int lo[2], hi[2];
            piece_stacks(s, &p->piece[k], lo, hi);
            listed += lo[0] <= hi[0] && lo[1] <= hi[1] ? (size_t)((hi[0] - lo[0]) / PATH_BLOCK + 2) *
                                                             (size_t)((hi[1] - lo[1]) / PATH_BLOCK + 2)
                                                       : 0;
            if (listed > 2 * (size_t)MOST_LISTED)
                return fail(E_USAGE, "a path of %zu pieces that each reach %d x %d stacks is too much", p->n,
                            hi[0] - lo[0] + 1, hi[1] - lo[1] + 1);
            for (int j = lo[1] / PATH_BLOCK; j <= hi[1] / PATH_BLOCK && lo[1] <= hi[1]; j++)
                for (int i = lo[0] / PATH_BLOCK; i <= hi[0] / PATH_BLOCK && lo[0] <= hi[0]; i++) {
                    size_t block = (size_t)j * (size_t)p->blocks[0] + (size_t)i;
                    if (pass)
                        p->list[p->first[block + 1]++] = (uint32_t)k;
                    else
                        p->first[block + 2]++;
                }
        }
        /* first[b + 1] is where block b's list begins, until the second pass has filled it to its end. */
        for (size_t b = 0; b < n && !pass; b++)
            p->first[b + 2] += p->first[b + 1];
        if (!pass)
            TRY(memory_alloc(p->first[n + 1], sizeof *p->list, "a path", &p->list));
    }
done:
    return st;
}

status path_create(const struct job_operation *op, const struct surface *surface, const struct stacks *s,
                   double from, double to, double reach, struct path *out)
{
    status st = OK;
    struct graph graph = {0};
    struct maker maker = {
        .graph = &graph, .surface = surface, .side = {0, 1, 0}, .from = from, .to = to, .path = out};
    *out = (struct path){0};
    if (surface)
        maker.smooth = *surface;
    make_profiles(out, op);
    TRY(graph_create(op, &graph));
    for (size_t arc = 0; arc < graph.n_arcs; arc++)
        TRY(add_arc(&maker, arc));
    for (size_t p = 0; p < op->n_points_m; p++)
        if (!graph.joined[p])
            TRY(add_point(&maker, p));
    for (size_t k = 0; k < out->n; k++)
        find_box(out, reach, &out->piece[k]);
    TRY(sort_into_blocks(out, s));
done:
    graph_free(&graph);
    if (st != OK)
        path_destroy(out);
    return st;
}

void path_destroy(struct path *p)
{
    free(p->piece);
    free(p->first);
    free(p->list);
    *p = (struct path){0};
}

void path_bounds(const struct path *p, int lo[2], int hi[2])
{
    lo[0] = lo[1] = INT32_MAX;
    hi[0] = hi[1] = -1;
    for (int j = 0; j < p->blocks[1]; j++)
        for (int i = 0; i < p->blocks[0]; i++) {
            size_t b = (size_t)j * (size_t)p->blocks[0] + (size_t)i;
            if (p->first[b] == p->first[b + 1])
                continue;
            const int at[2] = {i, j};
            for (int a = 0; a < 2; a++) {
                lo[a] = at[a] * PATH_BLOCK < lo[a] ? at[a] * PATH_BLOCK : lo[a];
                hi[a] =
                    at[a] * PATH_BLOCK + PATH_BLOCK - 1 > hi[a] ? at[a] * PATH_BLOCK + PATH_BLOCK - 1 : hi[a];
            }
        }
}

static const uint32_t *pieces_at(const struct path *p, int i, int j, size_t *n)
{
    size_t b = (size_t)(j / PATH_BLOCK) * (size_t)p->blocks[0] + (size_t)(i / PATH_BLOCK);
    *n = p->first[b + 1] - p->first[b];
    return p->list + p->first[b];
}

static bool covers(const struct path_piece *piece, const double x[2])
{
    return x[0] >= piece->lo[0] && x[0] <= piece->hi[0] && x[1] >= piece->lo[1] && x[1] <= piece->hi[1];
}

bool path_heights(const struct path *p, int i, int j, const double x[2], double *lo, double *hi)
{
    size_t n;
    const uint32_t *list = pieces_at(p, i, j, &n);
    *lo = HUGE_VAL;
    *hi = -HUGE_VAL;
    for (size_t k = 0; k < n; k++) {
        const struct path_piece *piece = &p->piece[list[k]];
        if (!covers(piece, x))
            continue;
        *lo = fmin(*lo, piece->lo[2]);
        *hi = fmax(*hi, piece->hi[2]);
    }
    return *hi > *lo;
}

/* ---- distances */

/* The library's do more than compare, and are asked for here more than anything else. */
static inline double smaller(double a, double b)
{
    return a < b ? a : b;
}

static inline double larger(double a, double b)
{
    return a > b ? a : b;
}

static double mix(double a, double b, double t)
{
    return a + t * (b - a);
}

static double in_capsule(const struct path_piece *piece, const double ax[3], const double bx[3],
                         double *radius)
{
    const double ab[3] = {ax[0] - bx[0], ax[1] - bx[1], ax[2] - bx[2]};
    double square = dot3(ab, ab), t = square > 0 ? smaller(larger(dot3(ax, ab) / square, 0), 1) : 0;
    const double d[3] = {ax[0] - t * ab[0], ax[1] - t * ab[1], ax[2] - t * ab[2]};
    *radius = mix(piece->end[0].radius, piece->end[1].radius, t);
    return sqrt(dot3(d, d)) - *radius;
}

/* A piece is a prism cut by the planes across its ends: neighbours share theirs, so that they neither overlap
 * nor gape. Not asked for more closely than `nearest`. */
static double in_prism(const struct path *p, const struct path_piece *piece, const double ax[3],
                       const double bx[3], double nearest, double *radius)
{
    const struct path_end *a = &piece->end[0], *b = &piece->end[1];
    double before = -dot3(ax, a->along), past = dot3(bx, b->along), length = -before - past;
    if (larger(before, past) >= nearest)
        return nearest;
    double t = length > 0 ? smaller(larger(-before / length, 0), 1) : 0.5;
    double x = mix(dot3(ax, a->side), dot3(bx, b->side), t), y = mix(dot3(ax, a->up), dot3(bx, b->up), t);
    int step = (int)lrint(mix(a->share, b->share, t) * (PROFILE_STEPS - 1));
    *radius = mix(a->radius, b->radius, t);
    double section = *radius * polygon_distance(p->profile[step], x / *radius, y / *radius);
    /* A plane between neighbours is no wall. */
    if (piece->first || before > 0)
        section = larger(section, before);
    return piece->last || past > 0 ? larger(section, past) : section;
}

double path_distance(const struct path *p, int i, int j, const double x[3], double *radius)
{
    size_t n;
    const uint32_t *list = pieces_at(p, i, j, &n);
    double nearest = HUGE_VAL;
    for (size_t k = 0; k < n; k++) {
        const struct path_piece *piece = &p->piece[list[k]];
        if (!covers(piece, x))
            continue;
        double r = piece->end[0].radius, own = larger(piece->lo[2] - x[2], x[2] - piece->hi[2]);
        if (own >= nearest)
            continue;
        if (own <= 0) {
            const double *a = piece->end[0].at, *b = piece->end[1].at;
            const double ax[3] = {x[0] - a[0], x[1] - a[1], x[2] - a[2]};
            const double bx[3] = {x[0] - b[0], x[1] - b[1], x[2] - b[2]};
            own = p->round ? in_capsule(piece, ax, bx, &r) : in_prism(p, piece, ax, bx, nearest, &r);
        }
        if (own < nearest) {
            nearest = own;
            *radius = r;
        }
    }
    return nearest;
}
