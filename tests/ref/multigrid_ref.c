#include "tests/ref/multigrid_ref.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#include "shared/params.h"

enum { LEVELS = 12, WIDE = 1032, COARSEST_CELLS = 4, FINEST_STEPS = 1, STEPS = 2, COARSEST_STEPS = 8 };

/* Three arrays one after the other, each with a row's room at both ends. */
struct vectors {
    float *memory, *x[3];
};

struct level {
    struct elastic_grid g;
    size_t nx, ny, nodes, n_cells;
    float *share, *inverse; /* [cells] of the full stiffness; [nodes] of the diagonal, 0: does not move */
    struct vectors r, z, other;
    float K[8][8][3][3];
};

struct multigrid_ref {
    int n;
    double most; /* the largest eigenvalue of an element by its diagonal */
    struct level level[LEVELS];
    struct vectors u, p, q;
    float *fill;
};

static bool vectors_create(const struct level *l, struct vectors *v)
{
    v->memory = calloc(3 * l->nodes + 2 * WIDE, sizeof *v->memory);
    for (int c = 0; c < 3 && v->memory; c++)
        v->x[c] = v->memory + WIDE + (size_t)c * l->nodes;
    return v->memory != NULL;
}

static bool level_create(struct level *l)
{
    double K[24][24];
    l->nx = (size_t)l->g.cells[0] + 1;
    l->ny = (size_t)l->g.cells[1] + 1;
    l->nodes = elastic_ref_node(&l->g, 0, 0, l->g.cells[2] + 1);
    l->n_cells = elastic_ref_cell(&l->g, 0, 0, l->g.cells[2]);
    elastic_ref_element(&l->g, K);
    for (int a = 0; a < 8; a++)
        for (int b = 0; b < 8; b++)
            for (int r = 0; r < 3; r++)
                for (int c = 0; c < 3; c++)
                    l->K[a][b][r][c] = (float)K[3 * a + r][3 * b + c];
    l->share = calloc(l->n_cells, sizeof *l->share);
    l->inverse = calloc(l->nodes, sizeof *l->inverse);
    return l->share && l->inverse && vectors_create(l, &l->r) && vectors_create(l, &l->z) &&
           vectors_create(l, &l->other);
}

static float share_of(float fill)
{
    return fill > 0 ? fmaxf(fill, STRESS_FILL_FLOOR) : 0;
}

static void set_inverse(struct level *l)
{
#pragma omp parallel for schedule(static)
    for (int k = 2; k < l->g.cells[2]; k++)
        for (int j = 1; j < l->g.cells[1]; j++)
            for (int i = 1; i < l->g.cells[0]; i++) {
                float sum = 0;
                for (int e = 0; e < 8; e++)
                    sum += l->share[elastic_ref_cell(&l->g, i - (e & 1), j - (e >> 1 & 1), k - (e >> 2))];
                l->inverse[elastic_ref_node(&l->g, i, j, k)] = sum > 0 ? 1 / (sum * l->K[0][0][0][0]) : 0;
            }
}

static void coarsen(const struct level *l, struct level *up)
{
    for (int k = 1; k < l->g.cells[2] - 1; k++)
        for (int j = 1; j < l->g.cells[1] - 1; j++)
            for (int i = 1; i < l->g.cells[0] - 1; i++)
                up->share[elastic_ref_cell(&up->g, (i + 1) / 2, (j + 1) / 2, (k + 1) / 2)] +=
                    l->share[elastic_ref_cell(&l->g, i, j, k)] / 8;
    for (size_t c = 0; c < up->n_cells; c++)
        up->share[c] = share_of(up->share[c]);
}

struct multigrid_ref *multigrid_ref_create(const struct elastic_grid *g, const float *fill)
{
    struct multigrid_ref *m = calloc(1, sizeof *m);
    bool ok = m != NULL;
    if (!ok)
        return NULL;
    m->most = (1.5 * g->lambda + g->mu) / ((g->lambda + 4 * g->mu) / 9);
    m->level[0].g = *g;
    for (bool more = true; ok && more;) {
        struct level *l = &m->level[m->n++];
        ok = level_create(l);
        if (m->n == 1)
            for (size_t c = 0; c < l->n_cells && ok; c++)
                l->share[c] = share_of(fill[c]);
        else if (ok)
            coarsen(l - 1, l);
        if (ok)
            set_inverse(l);
        more = false;
        l[1].g = l->g;
        l[1].g.dx *= 2;
        for (int a = 0; a < 3; a++) {
            more |= l->g.cells[a] - 2 > COARSEST_CELLS;
            l[1].g.cells[a] = (l->g.cells[a] - 1) / 2 + 2;
        }
    }
    struct level *l = &m->level[0];
    m->fill = ok ? malloc(l->n_cells * sizeof *fill) : NULL;
    ok = m->fill && vectors_create(l, &m->u) && vectors_create(l, &m->p) && vectors_create(l, &m->q);
    if (ok)
        memcpy(m->fill, fill, l->n_cells * sizeof *fill);
    else
        multigrid_ref_destroy(m);
    return ok ? m : NULL;
}

void multigrid_ref_destroy(struct multigrid_ref *m)
{
    for (int n = 0; n < m->n; n++) {
        struct level *l = &m->level[n];
        free(l->share);
        free(l->inverse);
        free(l->r.memory);
        free(l->z.memory);
        free(l->other.memory);
    }
    free(m->u.memory);
    free(m->p.memory);
    free(m->q.memory);
    free(m->fill);
    free(m);
}

/* ---- K u, a row of nodes at a time */

#pragma GCC push_options
#pragma GCC optimize("O3", "fast-math")
#if defined(__x86_64__)
#pragma GCC target("avx2,fma")
#endif
static __attribute__((noinline)) void row(const struct level *l, float *const u[3], float sum[3][WIDE], int j,
                                          int k)
{
    const int last = l->g.cells[0];
    const size_t bytes = (size_t)last * sizeof(float);
    float f0[WIDE], f1[WIDE], f2[WIDE];
    for (int c = 0; c < 3; c++)
        memset(sum[c], 0, bytes);
    for (int a = 0; a < 8; a++) {
        const int ax = a & 1, ay = a >> 1 & 1, az = a >> 2;
        const float *restrict share = l->share + elastic_ref_cell(&l->g, 0, j - ay, k - az) - ax;
        int any = 0;
        for (int i = 1; i < last; i++)
            any |= share[i] > 0;
        if (!any)
            continue;
        memset(f0, 0, bytes);
        memset(f1, 0, bytes);
        memset(f2, 0, bytes);
        for (int b = 0; b < 8; b += 2) {
            const size_t at =
                elastic_ref_node(&l->g, 0, j - ay + (b >> 1 & 1), k - az + (b >> 2)) - (size_t)ax;
            const float *restrict x = u[0] + at, *restrict y = u[1] + at, *restrict z = u[2] + at;
            float m[3][3], h[3][3];
            memcpy(m, l->K[a][b], sizeof m);
            memcpy(h, l->K[a][b + 1], sizeof h);
            for (int i = 1; i < last; i++) {
                float x0 = x[i], y0 = y[i], z0 = z[i], x1 = x[i + 1], y1 = y[i + 1], z1 = z[i + 1];
                f0[i] +=
                    m[0][0] * x0 + m[0][1] * y0 + m[0][2] * z0 + h[0][0] * x1 + h[0][1] * y1 + h[0][2] * z1;
                f1[i] +=
                    m[1][0] * x0 + m[1][1] * y0 + m[1][2] * z0 + h[1][0] * x1 + h[1][1] * y1 + h[1][2] * z1;
                f2[i] +=
                    m[2][0] * x0 + m[2][1] * y0 + m[2][2] * z0 + h[2][0] * x1 + h[2][1] * y1 + h[2][2] * z1;
            }
        }
        for (int i = 1; i < last; i++) {
            sum[0][i] += share[i] * f0[i];
            sum[1][i] += share[i] * f1[i];
            sum[2][i] += share[i] * f2[i];
        }
    }
}
#pragma GCC pop_options

/* to = of + scale K u at nodes that move; of: NULL is nothing. */
static void apply(const struct level *l, const struct vectors *u, float scale, const struct vectors *of,
                  struct vectors *to)
{
#pragma omp parallel for schedule(dynamic, 1)
    for (int k = 2; k < l->g.cells[2]; k++)
        for (int j = 1; j < l->g.cells[1]; j++) {
            float sum[3][WIDE];
            const size_t at = elastic_ref_node(&l->g, 0, j, k);
            row(l, u->x, sum, j, k);
            for (int c = 0; c < 3; c++)
                for (size_t i = 1; i < l->nx - 1; i++)
                    to->x[c][at + i] =
                        l->inverse[at + i] > 0 ? (of ? of->x[c][at + i] : 0) + scale * sum[c][i] : 0;
        }
}

/* ---- the cycle */

static void smooth(const struct multigrid_ref *m, struct level *l, int steps, bool fresh)
{
    for (int s = 0; s < steps; s++) {
        const float keep = s ? (float)((2.0 * s - 1) / (2.0 * s + 3)) : 0,
                    gain = (float)((steps == 1 ? 1.6 : (8.0 * s + 4) / (2.0 * s + 3)) / m->most);
        const bool none = fresh && s == 0;
#pragma omp parallel for schedule(dynamic, 1)
        for (int k = 2; k < l->g.cells[2]; k++)
            for (int j = 1; j < l->g.cells[1]; j++) {
                float sum[3][WIDE];
                const size_t at = elastic_ref_node(&l->g, 0, j, k);
                if (!none)
                    row(l, l->z.x, sum, j, k);
                for (int c = 0; c < 3; c++)
                    for (size_t i = 1; i < l->nx - 1; i++) {
                        const float now = none ? 0 : l->z.x[c][at + i],
                                    before = fresh && s <= 1 ? 0 : l->other.x[c][at + i];
                        l->other.x[c][at + i] =
                            now + (s ? keep * (now - before) : 0) +
                            gain * l->inverse[at + i] * (l->r.x[c][at + i] - (none ? 0 : sum[c][i]));
                    }
            }
        const struct vectors z = l->other;
        l->other = l->z;
        l->z = z;
    }
}

static void restrict_to(const struct level *l, struct level *up)
{
#pragma omp parallel for schedule(dynamic, 1)
    for (int k = 2; k < up->g.cells[2]; k++)
        for (int j = 1; j < up->g.cells[1]; j++)
            for (int i = 1; i < up->g.cells[0]; i++) {
                float sum[3] = {0};
                for (int e = 0; e < 27; e++) {
                    const int d[3] = {e % 3 - 1, e / 3 % 3 - 1, e / 9 - 1},
                              f[3] = {2 * i - 1 + d[0], 2 * j - 1 + d[1], 2 * k - 1 + d[2]};
                    if (f[0] > l->g.cells[0] || f[1] > l->g.cells[1] || f[2] > l->g.cells[2])
                        continue;
                    const float w = (float)((2 - abs(d[0])) * (2 - abs(d[1])) * (2 - abs(d[2]))) / 8;
                    for (int c = 0; c < 3; c++)
                        sum[c] += w * l->other.x[c][elastic_ref_node(&l->g, f[0], f[1], f[2])];
                }
                const size_t at = elastic_ref_node(&up->g, i, j, k);
                for (int c = 0; c < 3; c++)
                    up->r.x[c][at] = up->inverse[at] > 0 ? sum[c] : 0;
            }
}

static void prolong(const struct level *up, struct level *l)
{
#pragma omp parallel for schedule(dynamic, 1)
    for (int k = 2; k < l->g.cells[2]; k++)
        for (int j = 1; j < l->g.cells[1]; j++)
            for (int i = 1; i < l->g.cells[0]; i++) {
                const size_t at = elastic_ref_node(&l->g, i, j, k);
                for (int e = 0; e < 8 && l->inverse[at] > 0; e++) {
                    const size_t from = elastic_ref_node(&up->g, (i + 1 + (e & 1)) / 2,
                                                         (j + 1 + (e >> 1 & 1)) / 2, (k + 1 + (e >> 2)) / 2);
                    for (int c = 0; c < 3; c++)
                        l->z.x[c][at] += up->z.x[c][from] / 8;
                }
            }
}

static void cycle(struct multigrid_ref *m, int n, bool fresh)
{
    struct level *l = &m->level[n];
    const int steps = n == 0 ? FINEST_STEPS : STEPS;
    if (n == m->n - 1) {
        smooth(m, l, COARSEST_STEPS, fresh);
        return;
    }
    smooth(m, l, steps, fresh);
    apply(l, &l->z, -1, &l->r, &l->other);
    restrict_to(l, l + 1);
    cycle(m, n + 1, true);
    if (n + 1 < m->n - 1)
        cycle(m, n + 1, false);
    prolong(l + 1, l);
    smooth(m, l, steps, false);
}

/* ---- conjugate gradients */

static double dot(const struct level *l, const struct vectors *a, const struct vectors *b)
{
    double sum = 0;
    for (int c = 0; c < 3; c++) {
        const float *x = a->x[c], *y = b->x[c];
#pragma omp parallel for reduction(+ : sum)
        for (size_t i = 0; i < l->nodes; i++)
            sum += (double)x[i] * (double)y[i];
    }
    return sum;
}

/* y = x + scale y */
static void follow(const struct level *l, const struct vectors *x, float scale, struct vectors *y)
{
    for (int c = 0; c < 3; c++)
#pragma omp parallel for
        for (size_t i = 0; i < l->nodes; i++)
            y->x[c][i] = x->x[c][i] + scale * y->x[c][i];
}

/* y += scale x */
static void add(const struct level *l, float scale, const struct vectors *x, struct vectors *y)
{
    for (int c = 0; c < 3; c++)
#pragma omp parallel for
        for (size_t i = 0; i < l->nodes; i++)
            y->x[c][i] += scale * x->x[c][i];
}

static void load(struct multigrid_ref *m, double weight)
{
    struct level *l = &m->level[0];
    for (int k = 2; k < l->g.cells[2]; k++)
        for (int j = 1; j < l->g.cells[1]; j++)
            for (int i = 1; i < l->g.cells[0]; i++) {
                double sum = 0;
                for (int e = 0; e < 8; e++)
                    sum +=
                        (double)m->fill[elastic_ref_cell(&l->g, i - (e & 1), j - (e >> 1 & 1), k - (e >> 2))];
                l->r.x[2][elastic_ref_node(&l->g, i, j, k)] = (float)(-sum * weight / 8);
            }
}

void multigrid_ref_solve(struct multigrid_ref *m, double weight, int iterations, double *taken, float *u)
{
    struct level *l = &m->level[0];
    double before = 0;
    for (int c = 0; c < 3; c++) {
        memset(m->u.x[c], 0, l->nodes * sizeof(float));
        memset(l->r.x[c], 0, l->nodes * sizeof(float));
    }
    load(m, weight);
    for (int i = 0; i < iterations; i++) {
        cycle(m, 0, true);
        const double rz = dot(l, &l->r, &l->z);
        follow(l, &l->z, i ? (float)(rz / before) : 0, &m->p);
        apply(l, &m->p, 1, NULL, &m->q);
        const double alpha = rz / dot(l, &m->p, &m->q);
        add(l, (float)alpha, &m->p, &m->u);
        add(l, (float)-alpha, &m->q, &l->r);
        taken[i] = alpha * rz;
        before = rz;
    }
    for (size_t i = 0; i < l->nodes; i++)
        for (size_t c = 0; c < 3; c++)
            u[4 * i + c] = m->u.x[c][i];
}
