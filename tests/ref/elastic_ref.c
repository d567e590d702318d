#include "tests/ref/elastic_ref.h"

#include <math.h>
#include <string.h>

#include "shared/params.h"

size_t elastic_ref_cell(const struct elastic_grid *g, int i, int j, int k)
{
    return ((size_t)k * (size_t)g->cells[1] + (size_t)j) * (size_t)g->cells[0] + (size_t)i;
}

size_t elastic_ref_node(const struct elastic_grid *g, int i, int j, int k)
{
    return ((size_t)k * (size_t)(g->cells[1] + 1) + (size_t)j) * (size_t)(g->cells[0] + 1) + (size_t)i;
}

/* Strain (xx yy zz xy yz xz, engineering shear) from the 24 displacements, at x in -1..1 on each axis. */
static void strain_matrix(double dx, const double x[3], double B[6][24])
{
    memset(B, 0, 6 * sizeof *B);
    for (int b = 0; b < 8; b++) {
        double side[3] = {b & 1 ? 1 : -1, b & 2 ? 1 : -1, b & 4 ? 1 : -1}, slope[3];
        for (int a = 0; a < 3; a++) {
            double n = side[a] / 2;
            for (int c = 0; c < 3; c++)
                if (c != a)
                    n *= (1 + side[c] * x[c]) / 2;
            slope[a] = n * 2 / dx;
        }
        int at = 3 * b;
        B[0][at] = B[3][at + 1] = B[5][at + 2] = slope[0];
        B[1][at + 1] = B[3][at] = B[4][at + 2] = slope[1];
        B[2][at + 2] = B[4][at + 1] = B[5][at] = slope[2];
    }
}

static void stiffness(const struct elastic_grid *g, double D[6][6])
{
    memset(D, 0, 6 * sizeof *D);
    for (int i = 0; i < 3; i++) {
        for (int j = 0; j < 3; j++)
            D[i][j] = g->lambda;
        D[i][i] += 2 * g->mu;
        D[i + 3][i + 3] = g->mu;
    }
}

void elastic_ref_element(const struct elastic_grid *g, double K[24][24])
{
    double D[6][6], B[6][24], volume = pow(g->dx / 2, 3);
    stiffness(g, D);
    memset(K, 0, 24 * sizeof *K);
    for (int q = 0; q < 8; q++) {
        double at = 1 / sqrt(3), x[3] = {q & 1 ? at : -at, q & 2 ? at : -at, q & 4 ? at : -at};
        strain_matrix(g->dx, x, B);
        for (int r = 0; r < 24; r++)
            for (int c = 0; c < 24; c++)
                for (int i = 0; i < 6; i++)
                    for (int j = 0; j < 6; j++)
                        K[r][c] += volume * B[i][r] * D[i][j] * B[j][c];
    }
}

static const float *corner(const struct elastic_grid *g, const float *u, int i, int j, int k, int b)
{
    return u + 4 * elastic_ref_node(g, i + (b & 1), j + (b >> 1 & 1), k + (b >> 2));
}

void elastic_ref_apply(const struct elastic_grid *g, const float *fill, const float *u, double *force)
{
    double K[24][24];
    elastic_ref_element(g, K);
    memset(force, 0, elastic_ref_node(g, 0, 0, g->cells[2] + 1) * 4 * sizeof *force);
    for (int k = 0; k < g->cells[2]; k++)
        for (int j = 0; j < g->cells[1]; j++)
            for (int i = 0; i < g->cells[0]; i++) {
                double share = (double)fill[elastic_ref_cell(g, i, j, k)];
                if (share <= 0)
                    continue;
                share = fmax(share, (double)STRESS_FILL_FLOOR);
                for (int a = 0; a < 8; a++)
                    for (int r = 0; r < 3; r++) {
                        double sum = 0;
                        for (int b = 0; b < 8; b++)
                            for (int c = 0; c < 3; c++)
                                sum += K[3 * a + r][3 * b + c] * (double)corner(g, u, i, j, k, b)[c];
                        force[4 * elastic_ref_node(g, i + (a & 1), j + (a >> 1 & 1), k + (a >> 2)) +
                              (size_t)r] += share * sum;
                    }
            }
}

void elastic_ref_stress(const struct elastic_grid *g, const float *u, int i, int j, int k, double stress[6])
{
    double D[6][6], B[6][24], strain[6] = {0};
    stiffness(g, D);
    strain_matrix(g->dx, (double[]){0, 0, 0}, B);
    for (int e = 0; e < 6; e++)
        for (int b = 0; b < 8; b++)
            for (int c = 0; c < 3; c++)
                strain[e] += B[e][3 * b + c] * (double)corner(g, u, i, j, k, b)[c];
    for (int s = 0; s < 6; s++) {
        stress[s] = 0;
        for (int e = 0; e < 6; e++)
            stress[s] += D[s][e] * strain[e];
    }
}
