#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "base/vector.h"
#include "mesh/apart.h"
#include "mesh/boxes.h"

/* Steps of increasing tolerance, so that the collapses that change the surface least come first. */
static const double share_of_tolerance[] = {0.1, 0.3, 1};
enum { STEPS = sizeof share_of_tolerance / sizeof *share_of_tolerance, SWEEPS = 12 };

/* Limits: triangles of a vertex, vertices around it, rotation of a triangle's normal (60 degrees), and the quality of triangles. */
enum { MOST_TRIANGLES = 14, RING = 64 };
static const double COS_TURN = 0.5, LEAST_QUALITY = 0.02;

static const uint32_t GONE = UINT32_MAX;

struct star {
    size_t first; /* in the pool */
    uint32_t n;
};

struct simplify {
    struct trimesh *mesh;
    double tolerance2, longest2;
    struct boxes boxes;
    struct star *star; /* the triangles of every vertex */
    uint32_t *pool;
    size_t pool_n, pool_capacity;
    uint32_t *head, *next; /* linked lists of removed vertices, by the triangle nearest to them */
    float *normal;         /* of the original vertices */
    uint8_t *keep;         /* vertices that must not be removed */
    uint32_t *changed;     /* the sweep in which a vertex's neighbourhood last changed */
    uint32_t *tried;       /* the sweep in which a vertex was last tried in vain */
    uint32_t *mark, stamp; /* sets of vertices: those with mark == stamp */
    uint32_t sweep;
    struct boxes_found found;
    /* The vertex being tried and those removed around it, and the triangle of the fan that each is nearest to. */
    uint32_t *lost, *nearest;
    size_t n_lost, lost_capacity, nearest_capacity;
};

static const uint32_t *star_of(const struct simplify *s, uint32_t v)
{
    return s->pool + s->star[v].first;
}

static uint32_t *corners(const struct simplify *s, uint32_t t)
{
    return s->mesh->triangle + 3 * (size_t)t;
}

static bool has(const uint32_t c[3], uint32_t v)
{
    return c[0] == v || c[1] == v || c[2] == v;
}

static status pool_reserve(struct simplify *s, size_t n)
{
    return memory_grow(&s->pool, &s->pool_capacity, s->pool_n + n, sizeof *s->pool, "stars of vertices");
}

/* Lists and marks the vertices around v; returns their number, or -1 if there are too many. */
static int ring_of(struct simplify *s, uint32_t v, uint32_t ring[RING])
{
    int n = 0;
    s->stamp++;
    for (uint32_t i = 0; i < s->star[v].n; i++) {
        const uint32_t *c = corners(s, star_of(s, v)[i]);
        for (int k = 0; k < 3; k++) {
            if (c[k] == v || s->mark[c[k]] == s->stamp)
                continue;
            if (n == RING)
                return -1;
            s->mark[c[k]] = s->stamp;
            ring[n++] = c[k];
        }
    }
    return n;
}

/* The result of collapsing v into u. */
struct fan {
    int n;
    uint32_t old[MOST_TRIANGLES]; /* the triangles that are replaced */
    uint32_t corner[MOST_TRIANGLES][3];
    double cost;
};

static double squared(const double a[3], const float b[3])
{
    double sum = 0;
    for (int d = 0; d < 3; d++)
        sum += (a[d] - (double)b[d]) * (a[d] - (double)b[d]);
    return sum;
}

/* Whether a triangle's normal agrees with the original normals of its corners. Without this test, small bodies could turn inside out over
 * several collapses. */
static bool looks_out(const struct simplify *s, const uint32_t corner[3], const double n[3])
{
    for (int k = 0; k < 3; k++) {
        const float *own = s->normal + 3 * (size_t)corner[k];
        if (!(n[0] * (double)own[0] + n[1] * (double)own[1] + n[2] * (double)own[2] > 0))
            return false;
    }
    return true;
}

/* Twice the area divided by the square of the longest edge, at most 0.87; also returns the normal. */
static double quality(const double x[3][3], double normal[3])
{
    double e[3], f[3], longest = 0;
    minus3(x[1], x[0], e);
    minus3(x[2], x[0], f);
    cross3(e, f, normal);
    for (int i = 0; i < 3; i++) {
        minus3(x[(i + 1) % 3], x[i], e);
        longest = fmax(longest, dot3(e, e));
    }
    return longest > 0 ? sqrt(dot3(normal, normal)) / longest : 0;
}

/* Whether v may be collapsed into u, judging by the shapes of the triangles alone. `ring` of v is marked. */
static bool make_fan(struct simplify *s, uint32_t v, uint32_t u, struct fan *fan)
{
    const struct trimesh *m = s->mesh;
    const float *to = m->vertex + 3 * (size_t)u, *from = m->vertex + 3 * (size_t)v;
    double move[3], farthest = 0, worst = 1, worst_old = 1;
    uint32_t opposite[2] = {GONE, GONE};
    int sides = 0;
    fan->n = 0;
    for (int d = 0; d < 3; d++)
        move[d] = (double)to[d] - (double)from[d];
    for (uint32_t i = 0; i < s->star[v].n; i++) {
        uint32_t t = star_of(s, v)[i];
        const uint32_t *c = corners(s, t);
        double x[3][3], n[3], turned[3];
        boxes_corners(m, c, x);
        double q = quality((const double(*)[3])x, n), length = sqrt(dot3(n, n));
        if (length > 0)
            farthest = fmax(farthest, fabs(dot3(n, move)) / length);
        worst_old = fmin(worst_old, q);
        if (has(c, u)) {
            if (sides == 2)
                return false;
            for (int k = 0; k < 3; k++)
                if (c[k] != u && c[k] != v)
                    opposite[sides] = c[k];
            sides++;
            continue;
        }
        if (fan->n == MOST_TRIANGLES)
            return false;
        for (int k = 0; k < 3; k++) {
            fan->corner[fan->n][k] = c[k] == v ? u : c[k];
            if (c[k] == v)
                for (int d = 0; d < 3; d++)
                    x[k][d] = (double)to[d];
            else if (squared(x[k], to) > s->longest2)
                return false;
        }
        q = quality((const double(*)[3])x, turned);
        worst = fmin(worst, q);
        if (!(dot3(n, turned) > COS_TURN * length * sqrt(dot3(turned, turned))) ||
            !looks_out(s, fan->corner[fan->n], turned))
            return false;
        fan->old[fan->n++] = t;
    }
    if (sides != 2 || worst < fmin(LEAST_QUALITY, worst_old))
        return false;
    if (s->star[u].n + s->star[v].n > MOST_TRIANGLES + 4)
        return false;
    /* The rings of u and v must share only the two vertices opposite their edge, and these must keep three triangles. */
    for (uint32_t i = 0; i < s->star[u].n; i++) {
        const uint32_t *c = corners(s, star_of(s, u)[i]);
        for (int k = 0; k < 3; k++)
            if (c[k] != u && c[k] != v && s->mark[c[k]] == s->stamp && c[k] != opposite[0] &&
                c[k] != opposite[1])
                return false;
    }
    if (s->star[opposite[0]].n < 4 || s->star[opposite[1]].n < 4)
        return false;
    fan->cost = farthest * farthest / s->tolerance2 + 0.5 * (1 - worst);
    return farthest * farthest <= 4 * s->tolerance2;
}

static status lose(struct simplify *s, uint32_t v)
{
    status st = OK;
    TRY(memory_grow(&s->lost, &s->lost_capacity, s->n_lost + 1, sizeof *s->lost, "vertices that went"));
    s->lost[s->n_lost++] = v;
done:
    return st;
}

/* Lists the removed vertices around v. */
static status gather_lost(struct simplify *s, uint32_t v)
{
    status st = OK;
    s->n_lost = 0;
    TRY(lose(s, v));
    for (uint32_t i = 0; i < s->star[v].n; i++)
        for (uint32_t p = s->head[star_of(s, v)[i]]; p != GONE; p = s->next[p])
            TRY(lose(s, p));
    TRY(memory_grow(&s->nearest, &s->nearest_capacity, s->n_lost, sizeof *s->nearest, "vertices that went"));
done:
    return st;
}

/* Whether the fan is within the tolerance of all removed vertices. */
static bool is_true(const struct simplify *s, const struct fan *fan)
{
    double x[MOST_TRIANGLES][3][3];
    for (int f = 0; f < fan->n; f++)
        boxes_corners(s->mesh, fan->corner[f], x[f]);
    for (size_t i = 0; i < s->n_lost; i++) {
        double p[3], least = INFINITY;
        for (int d = 0; d < 3; d++)
            p[d] = (double)s->mesh->vertex[3 * (size_t)s->lost[i] + (size_t)d];
        for (int f = 0; f < fan->n; f++) {
            double d2 = triangle_distance2(p, (const double(*)[3])x[f]);
            if (d2 < least) {
                least = d2;
                s->nearest[i] = (uint32_t)f;
            }
        }
        if (!(least <= s->tolerance2))
            return false;
    }
    return true;
}

/* *yes: the fan does not intersect itself or other triangles. */
static status is_free(struct simplify *s, uint32_t v, const struct fan *fan, bool *yes)
{
    status st = OK;
    *yes = false;
    for (int f = 0; f < fan->n; f++)
        for (int g = 0; g < f; g++)
            if (!boxes_apart(s->mesh, fan->corner[f], fan->corner[g]))
                return OK;
    for (int f = 0; f < fan->n; f++) {
        float box[6];
        boxes_of(s->mesh, fan->corner[f], box);
        s->found.n = 0;
        TRY(boxes_find(&s->boxes, box, &s->found));
        for (size_t i = 0; i < s->found.n; i++) {
            const uint32_t *c = corners(s, s->found.triangle[i]);
            if (!has(c, v) && !boxes_apart(s->mesh, fan->corner[f], c))
                return OK;
        }
    }
    *yes = true;
done:
    return st;
}

static void leave_star(struct simplify *s, uint32_t v, uint32_t t)
{
    uint32_t *list = s->pool + s->star[v].first, n = 0;
    for (uint32_t i = 0; i < s->star[v].n; i++)
        if (list[i] != t)
            list[n++] = list[i];
    s->star[v].n = n;
}

static status draw(struct simplify *s, uint32_t v, uint32_t u, const struct fan *fan)
{
    status st = OK;
    TRY(pool_reserve(s, (size_t)s->star[u].n + (size_t)fan->n));
    for (uint32_t i = 0; i < s->star[v].n; i++) {
        uint32_t t = star_of(s, v)[i], *c = corners(s, t);
        s->head[t] = GONE;
        if (!has(c, u))
            continue;
        boxes_remove(&s->boxes, t);
        for (int k = 0; k < 3; k++)
            if (c[k] != v)
                leave_star(s, c[k], t);
        c[0] = c[1] = c[2] = GONE;
    }
    size_t first = s->pool_n;
    memcpy(s->pool + first, star_of(s, u), s->star[u].n * sizeof *s->pool);
    memcpy(s->pool + first + s->star[u].n, fan->old, (size_t)fan->n * sizeof *s->pool);
    s->star[u] = (struct star){first, s->star[u].n + (uint32_t)fan->n};
    s->pool_n += s->star[u].n;
    s->star[v].n = 0;
    for (int f = 0; f < fan->n; f++) {
        memcpy(corners(s, fan->old[f]), fan->corner[f], sizeof fan->corner[f]);
        TRY(boxes_add(&s->boxes, fan->old[f]));
        for (int k = 0; k < 3; k++)
            s->changed[fan->corner[f][k]] = s->sweep;
    }
    for (size_t i = 0; i < s->n_lost; i++) {
        uint32_t *head = &s->head[fan->old[s->nearest[i]]];
        s->next[s->lost[i]] = *head;
        *head = s->lost[i];
    }
done:
    return st;
}

/* Collapses v into the allowed neighbour with the least cost. */
static status try_vertex(struct simplify *s, uint32_t v, bool *drawn)
{
    enum { TRIES = 3 };
    status st = OK;
    uint32_t ring[RING], into[TRIES];
    struct fan fan, best[TRIES];
    int n = ring_of(s, v, ring), tries = 0;
    *drawn = false;
    for (int i = 0; i < n; i++) {
        if (!make_fan(s, v, ring[i], &fan))
            continue;
        int at = tries < TRIES ? tries++ : TRIES;
        for (; at > 0 && best[at - 1].cost > fan.cost; at--)
            if (at < TRIES) {
                best[at] = best[at - 1];
                into[at] = into[at - 1];
            }
        if (at < TRIES) {
            best[at] = fan;
            into[at] = ring[i];
        }
    }
    if (tries)
        TRY(gather_lost(s, v));
    for (int i = 0; i < tries && !*drawn; i++) {
        bool free_of_others = false;
        if (!is_true(s, &best[i]))
            continue;
        TRY(is_free(s, v, &best[i], &free_of_others));
        if (!free_of_others)
            continue;
        TRY(draw(s, v, into[i], &best[i]));
        *drawn = true;
    }
    if (!*drawn)
        s->tried[v] = s->sweep;
done:
    return st;
}

/* Never removes two neighbours in the same sweep, so that the remaining vertices are evenly distributed. */
static status sweep(struct simplify *s, size_t *n_drawn)
{
    status st = OK;
    s->sweep++;
    *n_drawn = 0;
    for (size_t v = 0; v < s->mesh->n_vertices; v++) {
        bool drawn;
        if (s->keep[v] || !s->star[v].n || s->changed[v] == s->sweep || s->tried[v] > s->changed[v])
            continue;
        TRY(try_vertex(s, (uint32_t)v, &drawn));
        *n_drawn += drawn;
    }
done:
    return st;
}

/* Marks the vertices at borders between labels to be kept. */
static void keep_borders(struct simplify *s, const uint32_t *label)
{
    for (size_t t = 0; label && t < s->mesh->n_triangles; t++) {
        const uint32_t *c = corners(s, (uint32_t)t);
        if (label[c[0]] != label[c[1]] || label[c[1]] != label[c[2]])
            s->keep[c[0]] = s->keep[c[1]] = s->keep[c[2]] = 1;
    }
}

static status make_stars(struct simplify *s)
{
    status st = OK;
    const struct trimesh *m = s->mesh;
    TRY(pool_reserve(s, 3 * m->n_triangles));
    for (size_t i = 0; i < 3 * m->n_triangles; i++)
        s->star[m->triangle[i]].n++;
    for (size_t v = 0; v < m->n_vertices; v++) {
        s->star[v].first = s->pool_n;
        s->pool_n += s->star[v].n;
        s->star[v].n = 0;
    }
    for (size_t i = 0; i < 3 * m->n_triangles; i++) {
        struct star *star = &s->star[m->triangle[i]];
        s->pool[star->first + star->n++] = (uint32_t)(i / 3);
    }
done:
    return st;
}

/* Compacts the mesh; the remaining vertices and triangles keep their order. */
static status gather(struct simplify *s, uint32_t **kept)
{
    status st = OK;
    struct trimesh *m = s->mesh;
    size_t n = 0, left = 0;
    TRY(memory_alloc(m->n_vertices, sizeof **kept, "vertices", kept));
    for (size_t v = 0; v < m->n_vertices; v++) {
        if (!s->star[v].n)
            continue;
        memmove(m->vertex + 3 * n, m->vertex + 3 * v, 3 * sizeof *m->vertex);
        s->mark[v] = (uint32_t)n;
        (*kept)[n++] = (uint32_t)v;
    }
    m->n_vertices = n;
    for (size_t t = 0; t < m->n_triangles; t++) {
        const uint32_t *c = m->triangle + 3 * t;
        if (c[0] == GONE)
            continue;
        for (int k = 0; k < 3; k++)
            m->triangle[3 * left + (size_t)k] = s->mark[c[k]];
        left++;
    }
    m->n_triangles = left;
done:
    return st;
}

status trimesh_simplify(struct trimesh *mesh, const uint32_t *label, double tolerance, double longest,
                        uint32_t **kept)
{
    status st = OK;
    struct simplify s = {.mesh = mesh, .longest2 = longest * longest};
    const char *what = "a simpler surface";
    *kept = NULL;
    TRY(memory_alloc(mesh->n_vertices, sizeof *s.star, what, &s.star));
    TRY(memory_alloc(mesh->n_vertices, sizeof *s.keep, what, &s.keep));
    TRY(memory_alloc(mesh->n_vertices, sizeof *s.changed, what, &s.changed));
    TRY(memory_alloc(mesh->n_vertices, sizeof *s.tried, what, &s.tried));
    TRY(memory_alloc(mesh->n_vertices, sizeof *s.mark, what, &s.mark));
    TRY(memory_alloc(mesh->n_vertices, sizeof *s.next, what, &s.next));
    TRY(memory_alloc(mesh->n_triangles, sizeof *s.head, what, &s.head));
    memset(s.head, 0xff, mesh->n_triangles * sizeof *s.head);
    TRY(memory_alloc(mesh->n_vertices, 3 * sizeof *s.normal, what, &s.normal));
    trimesh_normals(mesh, s.normal);
    TRY(make_stars(&s));
    TRY(boxes_create(&s.boxes, mesh, longest / 4));
    keep_borders(&s, label);
    for (int step = 0; step < STEPS && tolerance > 0; step++) {
        double reach = tolerance * share_of_tolerance[step];
        size_t drawn = 1, fewest = mesh->n_vertices / 1000;
        s.tolerance2 = reach * reach;
        memset(s.tried, 0, mesh->n_vertices * sizeof *s.tried);
        for (int i = 0; i < SWEEPS && drawn > (i ? fewest : 0); i++)
            TRY(sweep(&s, &drawn));
    }
    TRY(gather(&s, kept));
done:
    boxes_destroy(&s.boxes);
    free(s.star);
    free(s.pool);
    free(s.head);
    free(s.next);
    free(s.normal);
    free(s.keep);
    free(s.changed);
    free(s.tried);
    free(s.mark);
    free(s.found.triangle);
    free(s.lost);
    free(s.nearest);
    return st;
}
