#include "stacks/path.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "base/vector.h"

enum { MAX_SEGMENTS = 1 << 20, MAX_LISTED = 1 << 28 };

/* ---- small vectors */

static double normalize(double v[3])
{
    double length = sqrt(dot3(v, v));
    for (int a = 0; a < 3 && length > 0; a++)
        v[a] /= length;
    return length;
}

/* Catmull-Rom spline from p1 (t = 0) to p2 (t = 1), and its derivative. */
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

/* Fills a table with the blends of two profiles. */
static void make_table(struct path *p, size_t table, double ends[2][PROFILE_POINTS][2])
{
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
            p->profile[table * PROFILE_STEPS + (size_t)s][k] = e;
        }
    }
}

/* Signed distance to a closed polygon, negative inside by the even-odd rule. */
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
    size_t *into, *from; /* by point: the first arc that ends, or begins, there, plus 1; 0: none */
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

/* Shortest distances along the arcs (Bellman-Ford); a few passes suffice for arcs in any sensible order. */
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

/* ---- the profiles along the graph: one table for all of it, or if points have profiles of their own, one for each arc and each
 * isolated point */

static void profile_at_point(const struct graph *g, size_t point, double ends[2][PROFILE_POINTS][2],
                             double out[PROFILE_POINTS][2])
{
    const struct job_operation *op = g->op;
    const double share = g->longest > 0 ? g->distance[point] / g->longest : 0;
    for (int k = 0; k < PROFILE_POINTS; k++)
        for (int a = 0; a < 2; a++)
            out[k][a] = ends[0][k][a] + share * (ends[1][k][a] - ends[0][k][a]);
    for (size_t i = 0; i < op->n_profiles; i++)
        if ((size_t)op->profiles[i].point == point)
            curve_of((const double(*)[2])op->profiles[i].profile, op->profiles[i].n_profile, out);
}

static size_t table_of_point(const struct graph *g, size_t point)
{
    size_t table = g->n_arcs;
    for (size_t p = 0; p < point; p++)
        table += !g->joined[p];
    return table;
}

static status make_profiles(struct path *p, const struct graph *g)
{
    status st = OK;
    const struct job_operation *op = g->op;
    double ends[2][PROFILE_POINTS][2], own[2][PROFILE_POINTS][2];
    p->round = op->n_profile == 0;
    for (int a = 0; a < 2; a++) {
        p->lo[a] = -p->round;
        p->hi[a] = p->round;
    }
    if (p->round)
        return OK;
    curve_of((const double(*)[2])op->profile, op->n_profile, ends[0]);
    curve_of((const double(*)[2])(op->n_end_profile ? op->end_profile : op->profile), op->n_profile, ends[1]);
    const size_t n = op->n_profiles ? table_of_point(g, op->n_points_m) : 1;
    TRY(memory_alloc(n * PROFILE_STEPS, sizeof *p->profile, "profiles", &p->profile));
    if (!op->n_profiles) {
        make_table(p, 0, ends);
        return OK;
    }
    for (size_t arc = 0; arc < g->n_arcs; arc++) {
        size_t end[2];
        arc_of(g, arc, end);
        for (int e = 0; e < 2; e++)
            profile_at_point(g, end[e], ends, own[e]);
        make_table(p, arc, own);
    }
    for (size_t point = 0; point < op->n_points_m; point++)
        if (!g->joined[point]) {
            profile_at_point(g, point, ends, own[0]);
            memcpy(own[1], own[0], sizeof own[1]);
            make_table(p, table_of_point(g, point), own);
        }
done:
    return st;
}

/* ---- segments */

struct builder {
    const struct graph *graph;
    const struct surface *surface; /* NULL: not projected */
    struct surface smooth;         /* for normals, filtered over about the tool's width */
    double side[3];                /* the last side vector, which is kept where the path is parallel to up */
    double from, to;
    struct path *path;
};

/* Sets the frame of an end from its direction `along` and `up`. */
static void set_frame(struct builder *m, struct path_end *e, const double up[3])
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

static status make_end(struct builder *m, struct path_end *e)
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
    set_frame(m, e, up);
done:
    return st;
}

static status add_segment(struct path *p, const struct path_segment *segment)
{
    if (p->n >= MAX_SEGMENTS)
        return fail(E_USAGE,
                    "a path has more than %d segments of 0.3 radii: use fewer points, or larger radii",
                    MAX_SEGMENTS);
    status st = memory_grow(&p->segment, &p->capacity, p->n + 1, sizeof *p->segment, "a path");
    if (st == OK)
        p->segment[p->n++] = *segment;
    return st;
}

static status add_arc(struct builder *m, size_t arc)
{
    enum { MAX_ARC_SEGMENTS = 4096 };
    status st = OK;
    const struct graph *g = m->graph;
    size_t end[2], other[2];
    arc_of(g, arc, end);
    /* The control points before and after; at a free end they are extrapolated. */
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
    int n = (int)fmin(fmax(ceil(length / (0.3 * least)), 1), MAX_ARC_SEGMENTS);
    const bool own = g->op->n_profiles > 0;
    struct path_segment segment = {.table = own ? (uint32_t)arc : 0};
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
        e.step = own ? t : e.share;
        TRY(make_end(m, &e));
        segment.end[0] = segment.end[1];
        segment.end[1] = e;
        double share = 0.5 * (segment.end[0].share + e.share);
        segment.first = k == 1 && !g->into[end[0]];
        segment.last = k == n && !g->from[end[1]];
        if (k > 0 && share >= m->from && (share < m->to || m->to >= 1))
            TRY(add_segment(m->path, &segment));
    }
done:
    return st;
}

static status add_point(struct builder *m, size_t point)
{
    const double *at = m->graph->op->points_m[point];
    struct path_end e = {.at = {at[0], at[1], at[2]}, .radius = at[3], .along = {1, 0, 0}};
    status st = make_end(m, &e);
    if (st == OK && (m->from <= 0))
        st = add_segment(
            m->path, &(struct path_segment){
                         .end = {e, e},
                         .table = m->graph->op->n_profiles ? (uint32_t)table_of_point(m->graph, point) : 0});
    return st;
}

/* ---- segments by the stacks that they reach */

static void find_box(const struct path *p, double reach, struct path_segment *segment)
{
    for (int a = 0; a < 3; a++) {
        segment->lo[a] = HUGE_VAL;
        segment->hi[a] = -HUGE_VAL;
    }
    for (int corner = 0; corner < 8; corner++) {
        const struct path_end *e = &segment->end[corner & 1];
        double x = corner & 2 ? p->hi[0] + reach : p->lo[0] - reach;
        double y = corner & 4 ? p->hi[1] + reach : p->lo[1] - reach;
        for (int a = 0; a < 3; a++) {
            double at = e->at[a] + e->radius * (p->round ? 0 : x * e->side[a] + y * e->up[a]);
            double round = p->round ? (1 + reach) * e->radius : reach * e->radius;
            segment->lo[a] = fmin(segment->lo[a], at - round);
            segment->hi[a] = fmax(segment->hi[a], at + round);
        }
    }
}

static void segment_stacks(const struct stacks *s, const struct path_segment *segment, int lo[2], int hi[2])
{
    for (int a = 0; a < 2; a++) {
        lo[a] = (int)fmin(fmax(floor(segment->lo[a] / s->cell), 0), s->n[a]);
        hi[a] = (int)fmin(fmax(floor(segment->hi[a] / s->cell), -1), s->n[a] - 1);
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
            segment_stacks(s, &p->segment[k], lo, hi);
            listed += lo[0] <= hi[0] && lo[1] <= hi[1] ? (size_t)((hi[0] - lo[0]) / PATH_BLOCK + 2) *
                                                             (size_t)((hi[1] - lo[1]) / PATH_BLOCK + 2)
                                                       : 0;
            if (listed > 2 * (size_t)MAX_LISTED)
                return fail(
                    E_USAGE,
                    "a path of %zu segments, of which one reaches %d x %d stacks, is too large: use fewer points, or smaller radii",
                    p->n, hi[0] - lo[0] + 1, hi[1] - lo[1] + 1);
            for (int j = lo[1] / PATH_BLOCK; j <= hi[1] / PATH_BLOCK && lo[1] <= hi[1]; j++)
                for (int i = lo[0] / PATH_BLOCK; i <= hi[0] / PATH_BLOCK && lo[0] <= hi[0]; i++) {
                    size_t block = (size_t)j * (size_t)p->blocks[0] + (size_t)i;
                    if (pass)
                        p->list[p->first[block + 1]++] = (uint32_t)k;
                    else
                        p->first[block + 2]++;
                }
        }
        /* Before the second pass first[b + 1] is the begin of block b's list, after it the end. */
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
    struct builder builder = {
        .graph = &graph, .surface = surface, .side = {0, 1, 0}, .from = from, .to = to, .path = out};
    *out = (struct path){0};
    if (surface)
        builder.smooth = *surface;
    TRY(graph_create(op, &graph));
    TRY(make_profiles(out, &graph));
    for (size_t arc = 0; arc < graph.n_arcs; arc++)
        TRY(add_arc(&builder, arc));
    for (size_t p = 0; p < op->n_points_m; p++)
        if (!graph.joined[p])
            TRY(add_point(&builder, p));
    for (size_t k = 0; k < out->n; k++)
        find_box(out, reach, &out->segment[k]);
    TRY(sort_into_blocks(out, s));
done:
    graph_free(&graph);
    if (st != OK)
        path_destroy(out);
    return st;
}

void path_destroy(struct path *p)
{
    free(p->segment);
    free(p->profile);
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

static const uint32_t *segments_at(const struct path *p, int i, int j, size_t *n)
{
    size_t b = (size_t)(j / PATH_BLOCK) * (size_t)p->blocks[0] + (size_t)(i / PATH_BLOCK);
    *n = p->first[b + 1] - p->first[b];
    return p->list + p->first[b];
}

static bool covers(const struct path_segment *segment, const double x[2])
{
    return x[0] >= segment->lo[0] && x[0] <= segment->hi[0] && x[1] >= segment->lo[1] &&
           x[1] <= segment->hi[1];
}

bool path_heights(const struct path *p, int i, int j, const double x[2], double *lo, double *hi)
{
    size_t n;
    const uint32_t *list = segments_at(p, i, j, &n);
    *lo = HUGE_VAL;
    *hi = -HUGE_VAL;
    for (size_t k = 0; k < n; k++) {
        const struct path_segment *segment = &p->segment[list[k]];
        if (!covers(segment, x))
            continue;
        *lo = fmin(*lo, segment->lo[2]);
        *hi = fmax(*hi, segment->hi[2]);
    }
    return *hi > *lo;
}

/* ---- distances */

/* fmin() and fmax() also handle NaN, which costs time in the innermost loop. */
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

static double in_capsule(const struct path_segment *segment, const double ax[3], const double bx[3],
                         double *radius)
{
    const double ab[3] = {ax[0] - bx[0], ax[1] - bx[1], ax[2] - bx[2]};
    double square = dot3(ab, ab), t = square > 0 ? smaller(larger(dot3(ax, ab) / square, 0), 1) : 0;
    const double d[3] = {ax[0] - t * ab[0], ax[1] - t * ab[1], ax[2] - t * ab[2]};
    *radius = mix(segment->end[0].radius, segment->end[1].radius, t);
    return sqrt(dot3(d, d)) - *radius;
}

/* The distance to a segment with a profile: a prism cut by the planes across its ends, which neighbouring segments share, so that there
 * are neither overlaps nor gaps. Returns `nearest` if the segment is farther than that. */
static double in_prism(const struct path *p, const struct path_segment *segment, const double ax[3],
                       const double bx[3], double nearest, double *radius)
{
    const struct path_end *a = &segment->end[0], *b = &segment->end[1];
    double before = -dot3(ax, a->along), past = dot3(bx, b->along), length = -before - past;
    if (larger(before, past) >= nearest)
        return nearest;
    double t = length > 0 ? smaller(larger(-before / length, 0), 1) : 0.5;
    double x = mix(dot3(ax, a->side), dot3(bx, b->side), t), y = mix(dot3(ax, a->up), dot3(bx, b->up), t);
    size_t step = (size_t)lrint(mix(a->step, b->step, t) * (PROFILE_STEPS - 1));
    *radius = mix(a->radius, b->radius, t);
    double section = *radius * polygon_distance(p->profile[segment->table * PROFILE_STEPS + step],
                                                x / *radius, y / *radius);
    /* The plane between two segments is not a wall. */
    if (segment->first || before > 0)
        section = larger(section, before);
    return segment->last || past > 0 ? larger(section, past) : section;
}

double path_distance(const struct path *p, int i, int j, const double x[3], double *radius)
{
    size_t n;
    const uint32_t *list = segments_at(p, i, j, &n);
    double nearest = HUGE_VAL;
    for (size_t k = 0; k < n; k++) {
        const struct path_segment *segment = &p->segment[list[k]];
        if (!covers(segment, x))
            continue;
        double r = segment->end[0].radius, own = larger(segment->lo[2] - x[2], x[2] - segment->hi[2]);
        if (own >= nearest)
            continue;
        if (own <= 0) {
            const double *a = segment->end[0].at, *b = segment->end[1].at;
            const double ax[3] = {x[0] - a[0], x[1] - a[1], x[2] - a[2]};
            const double bx[3] = {x[0] - b[0], x[1] - b[1], x[2] - b[2]};
            own = p->round ? in_capsule(segment, ax, bx, &r) : in_prism(p, segment, ax, bx, nearest, &r);
        }
        if (own < nearest) {
            nearest = own;
            *radius = r;
        }
    }
    return nearest;
}
