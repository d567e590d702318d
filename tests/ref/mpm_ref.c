#include "tests/ref/mpm_ref.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

typedef double matrix[3][3];

static void multiply(matrix a, matrix b, matrix out)
{
    matrix c;
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) {
            c[i][j] = 0;
            for (int k = 0; k < 3; k++)
                c[i][j] += a[i][k] * b[k][j];
        }
    memcpy(out, c, sizeof c);
}

static void transposed(matrix a, matrix out)
{
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            out[i][j] = a[j][i];
}

static double determinant(matrix a)
{
    return a[0][0] * (a[1][1] * a[2][2] - a[1][2] * a[2][1]) -
           a[0][1] * (a[1][0] * a[2][2] - a[1][2] * a[2][0]) +
           a[0][2] * (a[1][0] * a[2][1] - a[1][1] * a[2][0]);
}

static void inverse(matrix a, matrix out)
{
    double d = determinant(a);
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) {
            int r = (j + 1) % 3, s = (j + 2) % 3, u = (i + 1) % 3, v = (i + 2) % 3;
            out[i][j] = (a[r][u] * a[s][v] - a[r][v] * a[s][u]) / d;
        }
}

/* F = R S, by many of Newton's steps. */
static void polar(matrix F, matrix R, matrix S)
{
    memcpy(R, F, sizeof(matrix));
    for (int step = 0; step < 60; step++) {
        matrix other, t;
        inverse(R, t);
        transposed(t, other);
        for (int i = 0; i < 3; i++)
            for (int j = 0; j < 3; j++)
                R[i][j] = 0.5 * (R[i][j] + other[i][j]);
    }
    matrix t;
    transposed(R, t);
    multiply(t, F, S);
}

/* Eigenvalues of a symmetric matrix by Jacobi's rotations; the largest. */
static double largest_eigenvalue(matrix symmetric)
{
    matrix a;
    memcpy(a, symmetric, sizeof a);
    for (int sweep = 0; sweep < 50; sweep++)
        for (int p = 0; p < 3; p++)
            for (int q = p + 1; q < 3; q++) {
                if (fabs(a[p][q]) < 1e-300)
                    continue;
                double theta = 0.5 * atan2(2 * a[p][q], a[q][q] - a[p][p]), c = cos(theta), s = sin(theta);
                matrix j = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, jt, t;
                j[p][p] = j[q][q] = c;
                j[p][q] = s;
                j[q][p] = -s;
                transposed(j, jt);
                multiply(jt, a, t);
                multiply(t, j, a);
            }
    return fmax(a[0][0], fmax(a[1][1], a[2][2]));
}

/* tau = 2 mu (F - R) F^T + lambda (J - 1) J I */
static void kirchhoff(const struct mpm_ref_rock *r, matrix F, matrix tau)
{
    matrix R, S, d, Ft;
    polar(F, R, S);
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            d[i][j] = 2 * r->mu * (F[i][j] - R[i][j]);
    transposed(F, Ft);
    multiply(d, Ft, tau);
    double J = determinant(F);
    for (int i = 0; i < 3; i++)
        tau[i][i] += r->lambda * (J - 1) * J;
}

double mpm_ref_energy(const struct mpm_ref_rock *r, const struct mpm_ref_particle *p)
{
    matrix F, R, S;
    memcpy(F, p->F, sizeof F);
    polar(F, R, S);
    double sum = 0, J = determinant(F), volume = p->share * pow(r->dx / 2, 3);
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            sum += (S[i][j] - (i == j)) * (S[i][j] - (i == j));
    return volume * (r->mu * sum + 0.5 * r->lambda * (J - 1) * (J - 1));
}

static void break_or_slide(const struct mpm_ref_rock *r, struct mpm_ref_particle *p)
{
    matrix R, S, tau, t, u;
    polar(p->F, R, S);
    if (p->apart < 0) {
        kirchhoff(r, p->F, tau);
        if (largest_eigenvalue(tau) <= p->strength)
            return;
        p->apart = 0;
    }
    matrix e;
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            e[i][j] = 0.5 * (S[i][j] + S[j][i]) - (i == j);
    double volume = e[0][0] + e[1][1] + e[2][2], trace = volume + p->apart, size = 0;
    if (trace >= 0) {
        p->apart = trace;
        memcpy(p->F, R, sizeof(matrix));
        return;
    }
    p->apart = 0;
    for (int i = 0; i < 3; i++)
        e[i][i] -= volume / 3;
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            size += e[i][j] * e[i][j];
    size = sqrt(size);
    double allowed = -r->alpha * (3 * r->lambda + 2 * r->mu) / (2 * r->mu) * trace;
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            t[i][j] = (i == j ? 1 + trace / 3 : 0) + (size > allowed ? allowed / size : 1) * e[i][j];
    multiply(R, t, u);
    memcpy(p->F, u, sizeof u);
}

static double weight(double away)
{
    double a = fabs(away);
    return a < 0.5 ? 0.75 - a * a : a < 1.5 ? 0.5 * (1.5 - a) * (1.5 - a) : 0;
}

static void on_ground(const struct mpm_ref_rock *r, double v[3])
{
    if (v[2] >= 0)
        return;
    double speed = hypot(v[0], v[1]), left = speed > 0 ? fmax(0, 1 + r->friction * v[2] / speed) : 0;
    v[0] *= left;
    v[1] *= left;
    v[2] = 0;
}

void mpm_ref_step(const struct mpm_ref_rock *r, struct mpm_ref_particle *p, size_t n)
{
    int size[3] = {r->cells[0] + 3, r->cells[1] + 3, r->cells[2] + 3};
    size_t nodes = (size_t)size[0] * (size_t)size[1] * (size_t)size[2];
    double(*grid)[4] = calloc(nodes, sizeof *grid), whole = r->density * pow(r->dx / 2, 3);
#define EACH_NODE(q)                                                                                         \
    for (int k = 0; k < size[2]; k++)                                                                        \
        for (int j = 0; j < size[1]; j++)                                                                    \
            for (int i = 0; i < size[0]; i++) {                                                              \
                double d[3] = {i - 1 - (q)->x[0] / r->dx, j - 1 - (q)->x[1] / r->dx,                         \
                               k - 1.75 - (q)->x[2] / r->dx};                                                \
                double w = weight(d[0]) * weight(d[1]) * weight(d[2]);                                       \
                double *node =                                                                               \
                    grid[((size_t)k * (size_t)size[1] + (size_t)j) * (size_t)size[0] + (size_t)i];           \
                if (w > 0) {
#define END_NODE                                                                                             \
    }                                                                                                        \
    }
    for (size_t s = 0; s < n; s++) {
        matrix Q;
        double m = whole * p[s].share, volume = m / r->density;
        kirchhoff(r, p[s].F, Q);
        double power = 0, square = 0;
        for (int a = 0; a < 3; a++)
            for (int b = 0; b < 3; b++) {
                power += Q[a][b] * p[s].C[a][b];
                square += Q[a][b] * Q[a][b];
            }
        double back = fmin(1, fmax(0, -power / (0.2 * sqrt(square) + 1e-30)));
        for (int a = 0; a < 3; a++)
            for (int b = 0; b < 3; b++)
                Q[a][b] *= 1 + back * (r->rebound - 1);
        for (int a = 0; a < 3; a++)
            for (int b = 0; b < 3; b++)
                Q[a][b] = m * p[s].C[a][b] - 4 * r->dt * volume / (r->dx * r->dx) *
                                                 (Q[a][b] + r->viscosity * (p[s].C[a][b] + p[s].C[b][a]));
        EACH_NODE(&p[s])
        for (int a = 0; a < 3; a++) {
            node[a] += w * m * p[s].v[a];
            for (int b = 0; b < 3; b++)
                node[a] += w * Q[a][b] * d[b] * r->dx;
        }
        node[3] += w * m;
        END_NODE
    }
    for (size_t c = 0; c < nodes; c++)
        if (grid[c][3] > 0) {
            for (int a = 0; a < 3; a++)
                grid[c][a] /= grid[c][3];
            grid[c][2] -= r->gravity * r->dt;
            if (c / ((size_t)size[0] * (size_t)size[1]) <= 1)
                on_ground(r, grid[c]);
        }
    for (size_t s = 0; s < n; s++) {
        matrix step;
        memset(p[s].v, 0, sizeof p[s].v);
        memset(p[s].C, 0, sizeof p[s].C);
        EACH_NODE(&p[s])
        for (int a = 0; a < 3; a++) {
            p[s].v[a] += w * node[a];
            for (int b = 0; b < 3; b++)
                p[s].C[a][b] += 4 / r->dx * w * node[a] * d[b];
        }
        END_NODE
        for (int a = 0; a < 3; a++)
            for (int b = 0; b < 3; b++)
                step[a][b] = (a == b) + r->dt * p[s].C[a][b];
        multiply(step, p[s].F, p[s].F);
        break_or_slide(r, &p[s]);
        for (int a = 0; a < 3; a++)
            p[s].x[a] += r->dt * p[s].v[a];
        if (p[s].x[2] < 0) {
            p[s].x[2] = 0;
            on_ground(r, p[s].v);
        }
    }
    free(grid);
}
