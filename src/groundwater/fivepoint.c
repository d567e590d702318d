#include "groundwater/fivepoint.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"

enum { LEVELS = 16, COARSEST_SWEEPS = 30, VECTORS = 7 };

struct level {
    struct fivepoint A;
    double *x, *b;
    size_t n;
};

struct fivepoint_solver {
    struct level level[LEVELS];
    int n_levels;
    double *vector[VECTORS]; /* of BiCGSTAB */
};

static status create_level(struct level *l, const int n[2])
{
    status st = OK;
    memcpy(l->A.n, n, sizeof l->A.n);
    l->n = (size_t)n[0] * (size_t)n[1];
    TRY(memory_alloc(l->n, sizeof(double), "groundwater's equations", &l->A.diagonal));
    for (int d = 0; d < NEIGHBOURS; d++)
        TRY(memory_alloc(l->n, sizeof(double), "groundwater's equations", &l->A.coupling[d]));
    TRY(memory_alloc(l->n, sizeof(double), "groundwater's equations", &l->x));
    TRY(memory_alloc(l->n, sizeof(double), "groundwater's equations", &l->b));
done:
    return st;
}

status fivepoint_create(const int n[2], struct fivepoint_solver **out)
{
    status st = OK;
    struct fivepoint_solver *s = NULL;
    int size[2] = {n[0], n[1]};
    TRY(memory_alloc(1, sizeof *s, "groundwater's equations", &s));
    while (s->n_levels < LEVELS) {
        TRY(create_level(&s->level[s->n_levels++], size));
        if (size[0] * size[1] <= 4)
            break;
        for (int a = 0; a < 2; a++)
            size[a] = (size[a] + 1) / 2;
    }
    for (int v = 0; v < VECTORS; v++)
        TRY(memory_alloc(s->level[0].n, sizeof(double), "groundwater's equations", &s->vector[v]));
    *out = s;
    s = NULL;
done:
    fivepoint_destroy(&s);
    return st;
}

void fivepoint_destroy(struct fivepoint_solver **solver)
{
    struct fivepoint_solver *s = *solver;
    for (int i = 0; s && i < s->n_levels; i++) {
        struct level *l = &s->level[i];
        free(l->A.diagonal);
        for (int d = 0; d < NEIGHBOURS; d++)
            free(l->A.coupling[d]);
        free(l->x);
        free(l->b);
    }
    for (int v = 0; s && v < VECTORS; v++)
        free(s->vector[v]);
    free(s);
    *solver = NULL;
}

struct fivepoint *fivepoint_matrix(struct fivepoint_solver *solver)
{
    return &solver->level[0].A;
}

/* Sum over a row's neighbours of entry times x. */
static double around(const struct fivepoint *A, const double *x, size_t c)
{
    const size_t nx = (size_t)A->n[0];
    double sum = 0;
    if (A->coupling[WEST][c] != 0)
        sum += A->coupling[WEST][c] * x[c - 1];
    if (A->coupling[EAST][c] != 0)
        sum += A->coupling[EAST][c] * x[c + 1];
    if (A->coupling[SOUTH][c] != 0)
        sum += A->coupling[SOUTH][c] * x[c - nx];
    if (A->coupling[NORTH][c] != 0)
        sum += A->coupling[NORTH][c] * x[c + nx];
    return sum;
}

static void multiply(const struct fivepoint *A, size_t n, const double *x, double *out)
{
    for (size_t c = 0; c < n; c++)
        out[c] = A->diagonal[c] * x[c] + around(A, x, c);
}

/* ---- multigrid */

/* Coarse matrix: equations and unknowns of 2 x 2 cells added. */
static void join(const struct level *fine, struct level *coarse)
{
    const int *n = fine->A.n;
    memset(coarse->A.diagonal, 0, coarse->n * sizeof(double));
    for (int d = 0; d < NEIGHBOURS; d++)
        memset(coarse->A.coupling[d], 0, coarse->n * sizeof(double));
    for (int j = 0; j < n[1]; j++)
        for (int i = 0; i < n[0]; i++) {
            const size_t c = (size_t)j * (size_t)n[0] + (size_t)i,
                         to = (size_t)(j / 2) * (size_t)coarse->A.n[0] + (size_t)(i / 2);
            const bool inside[NEIGHBOURS] = {i % 2 == 1, i % 2 == 0, j % 2 == 1, j % 2 == 0};
            coarse->A.diagonal[to] += fine->A.diagonal[c];
            for (int d = 0; d < NEIGHBOURS; d++)
                *(inside[d] ? &coarse->A.diagonal[to] : &coarse->A.coupling[d][to]) += fine->A.coupling[d][c];
        }
}

static void sweep(struct level *l, bool back)
{
    for (size_t k = 0; k < l->n; k++) {
        const size_t c = back ? l->n - 1 - k : k;
        if (l->A.diagonal[c] > 0)
            l->x[c] = (l->b[c] - around(&l->A, l->x, c)) / l->A.diagonal[c];
    }
}

/* Restricts the residual: sum over 2 x 2 cells. */
static void restrict_rest(const struct level *fine, struct level *coarse)
{
    const size_t nx = (size_t)fine->A.n[0], ny = (size_t)fine->A.n[1];
    memset(coarse->b, 0, coarse->n * sizeof(double));
    for (size_t j = 0, c = 0; j < ny; j++)
        for (size_t i = 0; i < nx; i++, c++)
            coarse->b[j / 2 * (size_t)coarse->A.n[0] + i / 2] +=
                fine->b[c] - fine->A.diagonal[c] * fine->x[c] - around(&fine->A, fine->x, c);
}

static void correct(struct level *fine, const struct level *coarse)
{
    const size_t nx = (size_t)fine->A.n[0], ny = (size_t)fine->A.n[1];
    for (size_t j = 0, c = 0; j < ny; j++)
        for (size_t i = 0; i < nx; i++, c++)
            if (fine->A.diagonal[c] > 0)
                fine->x[c] += coarse->x[j / 2 * (size_t)coarse->A.n[0] + i / 2];
}

/* One W-cycle from x = 0: level->x approximates the solution for level->b. */
static void cycle(struct fivepoint_solver *s, int depth)
{
    struct level *l = &s->level[depth];
    memset(l->x, 0, l->n * sizeof(double));
    if (depth + 1 == s->n_levels) {
        for (int i = 0; i < COARSEST_SWEEPS; i++)
            sweep(l, i % 2 == 1);
        return;
    }
    sweep(l, false);
    for (int visit = 0; visit < (depth > 0 ? 2 : 1); visit++) {
        restrict_rest(l, l + 1);
        cycle(s, depth + 1);
        correct(l, l + 1);
        sweep(l, true);
    }
}

static void precondition(struct fivepoint_solver *s, const double *b, double *x)
{
    memcpy(s->level[0].b, b, s->level[0].n * sizeof(double));
    cycle(s, 0);
    memcpy(x, s->level[0].x, s->level[0].n * sizeof(double));
}

/* ---- BiCGSTAB */

static double dot(const double *a, const double *b, size_t n)
{
    double sum = 0;
    for (size_t i = 0; i < n; i++)
        sum += a[i] * b[i];
    return sum;
}

static double size_of(const double *a, size_t n)
{
    double sum = 0;
    for (size_t i = 0; i < n; i++)
        sum += fabs(a[i]);
    return sum;
}

static void add(double *to, double factor, const double *a, size_t n)
{
    for (size_t i = 0; i < n; i++)
        to[i] += factor * a[i];
}

int fivepoint_solve(struct fivepoint_solver *s, const double *b, double *x, double tolerance, int most)
{
    const size_t n = s->level[0].n;
    const struct fivepoint *A = &s->level[0].A;
    double *r = s->vector[0], *shadow = s->vector[1], *p = s->vector[2], *v = s->vector[3], *y = s->vector[4],
           *z = s->vector[5], *t = s->vector[6];
    double rho = 1, alpha = 1, omega = 1;
    const double enough = tolerance * size_of(b, n);
    int i = 0;
    for (int l = 0; l + 1 < s->n_levels; l++)
        join(&s->level[l], &s->level[l + 1]);
    memset(x, 0, n * sizeof *x);
    memcpy(r, b, n * sizeof *r);
    memcpy(shadow, b, n * sizeof *r);
    memset(p, 0, n * sizeof *p);
    memset(v, 0, n * sizeof *v);
    while (i < most && size_of(r, n) > enough) {
        const double next = dot(shadow, r, n), beta = next / rho * (alpha / omega);
        i++;
        if (next == 0)
            break;
        for (size_t c = 0; c < n; c++)
            p[c] = r[c] + beta * (p[c] - omega * v[c]);
        precondition(s, p, y);
        multiply(A, n, y, v);
        rho = next;
        alpha = rho / dot(shadow, v, n);
        if (!isfinite(alpha))
            break;
        add(x, alpha, y, n);
        add(r, -alpha, v, n);
        precondition(s, r, z);
        multiply(A, n, z, t);
        const double square = dot(t, t, n);
        if (square == 0)
            break;
        omega = dot(t, r, n) / square;
        add(x, omega, z, n);
        add(r, -omega, t, n);
        if (omega == 0)
            break;
    }
    return i;
}
