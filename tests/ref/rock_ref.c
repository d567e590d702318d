#include "tests/ref/rock_ref.h"

#include <math.h>
#include <stdlib.h>

#include "shared/params.h"

static void voxel_of(const float *P, const int n[3], double h, int v[3])
{
    for (int a = 0; a < 3; a++) {
        v[a] = (int)floorf(P[a] / (float)h);
        v[a] = v[a] < 0 ? 0 : v[a] >= n[a] ? n[a] - 1 : v[a];
    }
}

static size_t voxel_index(const int n[3], int i, int j, int k)
{
    return ((size_t)k * (size_t)n[1] + (size_t)j) * (size_t)n[0] + (size_t)i;
}

static int inside(const int n[3], int i, int j, int k)
{
    return i >= 0 && j >= 0 && k >= 0 && i < n[0] && j < n[1] && k < n[2];
}

static const int face[6][3] = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};

uint8_t *rock_ref_voxels(const struct rock *rock, const int n[3], double h)
{
    uint8_t *out = calloc((size_t)n[0] * (size_t)n[1] * (size_t)n[2], 1);
    for (size_t i = 0; i < rock->n; i++) {
        int v[3];
        voxel_of(&rock->P[4 * i], n, h, v);
        out[voxel_index(n, v[0], v[1], v[2])] = 1;
    }
    return out;
}

int rock_ref_bare(const uint8_t *voxels, const int n[3], double h, const float *P)
{
    int v[3], bare = 0;
    voxel_of(P, n, h, v);
    for (int f = 0; f < 6; f++) {
        int i = v[0] + face[f][0], j = v[1] + face[f][1], k = v[2] + face[f][2];
        if (k >= 0)
            bare |= !inside(n, i, j, k) || !voxels[voxel_index(n, i, j, k)];
    }
    return bare;
}

/* Jacobi's rotations: A becomes diagonal, V holds the eigenvectors in its columns. */
static void jacobi(double A[3][3], double V[3][3])
{
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            V[i][j] = i == j;
    for (int sweep = 0; sweep < 30; sweep++)
        for (int p = 0; p < 2; p++)
            for (int q = p + 1; q < 3; q++) {
                if (fabs(A[p][q]) < 1e-300)
                    continue;
                double theta = (A[q][q] - A[p][p]) / (2 * A[p][q]);
                double t = (theta >= 0 ? 1 : -1) / (fabs(theta) + sqrt(theta * theta + 1));
                double c = 1 / sqrt(t * t + 1), s = t * c;
                for (int k = 0; k < 3; k++) {
                    double x = A[k][p], y = A[k][q];
                    A[k][p] = c * x - s * y;
                    A[k][q] = s * x + c * y;
                }
                for (int k = 0; k < 3; k++) {
                    double x = A[p][k], y = A[q][k];
                    A[p][k] = c * x - s * y;
                    A[q][k] = s * x + c * y;
                }
                for (int k = 0; k < 3; k++) {
                    double x = V[k][p], y = V[k][q];
                    V[k][p] = c * x - s * y;
                    V[k][q] = s * x + c * y;
                }
            }
}

struct near {
    double d2;
    size_t i;
};

static int by_distance(const void *a, const void *b)
{
    double x = ((const struct near *)a)->d2, y = ((const struct near *)b)->d2;
    return (x > y) - (x < y);
}

void rock_ref_normal(const struct rock *rock, size_t self, size_t k, double h, double normal[3],
                     double *margin)
{
    struct near *near = malloc(rock->n * sizeof *near);
    double mean[3] = {0}, A[3][3] = {{0}}, V[3][3], inward[3] = {0};
    const float *x = &rock->P[4 * self];
    for (size_t i = 0; i < rock->n; i++) {
        double d2 = 0;
        int close = 1;
        for (int a = 0; a < 3; a++) {
            d2 += pow((double)(rock->P[4 * i + (size_t)a] - x[a]) / h, 2);
            close &=
                abs((int)floorf(rock->P[4 * i + (size_t)a] / (float)h) - (int)floorf(x[a] / (float)h)) <= 2;
        }
        near[i] = (struct near){d2, i};
        for (int a = 0; close && a < 3; a++)
            inward[a] += (double)(rock->P[4 * i + (size_t)a] - x[a]);
    }
    qsort(near, rock->n, sizeof *near, by_distance); /* itself first */
    *margin = rock->n > k + 1 ? near[k + 1].d2 - near[k].d2 : INFINITY;
    for (size_t i = 0; i <= k; i++)
        for (int a = 0; a < 3; a++)
            mean[a] += (double)(rock->P[4 * near[i].i + (size_t)a] - x[a]) / (double)(k + 1);
    for (size_t i = 0; i <= k; i++)
        for (int a = 0; a < 3; a++)
            for (int b = 0; b < 3; b++)
                A[a][b] += ((double)(rock->P[4 * near[i].i + (size_t)a] - x[a]) - mean[a]) *
                           ((double)(rock->P[4 * near[i].i + (size_t)b] - x[b]) - mean[b]);
    jacobi(A, V);
    int least = A[0][0] <= A[1][1] && A[0][0] <= A[2][2] ? 0 : A[1][1] <= A[2][2] ? 1 : 2;
    double side = 0;
    for (int a = 0; a < 3; a++)
        side += V[a][least] * inward[a];
    for (int a = 0; a < 3; a++)
        normal[a] = side > 0 ? -V[a][least] : V[a][least];
    free(near);
}

/* ---- blocks: union-find over the voxels in which the surface field is inside */

static float fill_at(const float *fill, const int n[3], int i, int j, int k)
{
    k = k < 0 ? 0 : k; /* below the ground is more of the same */
    return inside(n, i, j, k) ? fill[voxel_index(n, i, j, k)] : 0;
}

static float share_at(const float *fill, const int n[3], int i, int j, int k)
{
    float faces = 0, edges = 0;
    for (int s = -1; s <= 1; s += 2) {
        faces +=
            fill_at(fill, n, i + s, j, k) + fill_at(fill, n, i, j + s, k) + fill_at(fill, n, i, j, k + s);
        for (int t = -1; t <= 1; t += 2)
            edges += fill_at(fill, n, i + s, j + t, k) + fill_at(fill, n, i + s, j, k + t) +
                     fill_at(fill, n, i, j + s, k + t);
    }
    return SHARE_SELF * fill_at(fill, n, i, j, k) + SHARE_FACE * faces + SHARE_EDGE * edges;
}

static size_t root_of(size_t *parent, size_t v)
{
    while (parent[v] != v)
        v = parent[v] = parent[parent[v]];
    return v;
}

uint8_t *rock_ref_falls(const struct rock *rock, const int n[3], double h)
{
    size_t voxels = (size_t)n[0] * (size_t)n[1] * (size_t)n[2], ground = voxels;
    float *fill = calloc(voxels, sizeof *fill);
    uint8_t *solid = calloc(voxels, 1), *falls = calloc(rock->n, 1);
    size_t *parent = calloc(voxels + 1, sizeof *parent);
    int v[3];
    for (size_t i = 0; i < rock->n; i++) {
        voxel_of(&rock->P[4 * i], n, h, v);
        fill[voxel_index(n, v[0], v[1], v[2])] += rock->viability[i];
    }
    for (size_t i = 0; i <= voxels; i++)
        parent[i] = i;
    for (int k = 0; k < n[2]; k++)
        for (int j = 0; j < n[1]; j++)
            for (int i = 0; i < n[0]; i++) {
                size_t at = voxel_index(n, i, j, k);
                solid[at] = fill[at] > 0 && share_at(fill, n, i, j, k) >= 0.5f;
            }
    for (int k = 0; k < n[2]; k++)
        for (int j = 0; j < n[1]; j++)
            for (int i = 0; i < n[0]; i++) {
                size_t at = voxel_index(n, i, j, k);
                if (!solid[at])
                    continue;
                if (k == 0)
                    parent[root_of(parent, at)] = root_of(parent, ground);
                for (int f = 0; f < 6; f += 2)
                    if (inside(n, i + face[f][0], j + face[f][1], k + face[f][2])) {
                        size_t other = voxel_index(n, i + face[f][0], j + face[f][1], k + face[f][2]);
                        if (solid[other])
                            parent[root_of(parent, other)] = root_of(parent, at);
                    }
            }
    for (size_t i = 0; i < rock->n; i++) {
        int held = 0;
        voxel_of(&rock->P[4 * i], n, h, v);
        for (int f = -1; f < 6; f++) { /* its own voxel, then those across its faces */
            int at[3] = {v[0], v[1], v[2]};
            for (int a = 0; f >= 0 && a < 3; a++)
                at[a] += face[f][a];
            if (inside(n, at[0], at[1], at[2]) && solid[voxel_index(n, at[0], at[1], at[2])])
                held |= root_of(parent, voxel_index(n, at[0], at[1], at[2])) == root_of(parent, ground);
        }
        falls[i] = !held;
    }
    free(fill);
    free(solid);
    free(parent);
    return falls;
}

double rock_ref_retreat(double weak, double strong, double threshold, double factor, double stress,
                        double band)
{
    if (band <= 0)
        return factor * (stress > threshold ? strong : weak);
    double low = threshold * (1 - band / 2), high = threshold * (1 + band / 2);
    if (stress <= low)
        return factor * weak;
    if (stress >= high)
        return factor * strong;
    double held = (stress - low) / (high - low);
    if (weak <= 0 || strong <= 0)
        return factor * (weak + held * (strong - weak));
    return factor * exp((1 - held) * log(weak) + held * log(strong));
}
