#include "wind_ref.h"

#include <math.h>
#include <stdlib.h>

static const double support = 2, pi = 3.14159265358979323846;

double wind_ref_kernel(double r)
{
    double q = r / support, scale = 8 / (pi * support * support * support);
    if (q <= 0.5)
        return scale * (6 * (q * q * q - q * q) + 1);
    return q < 1 ? scale * 2 * pow(1 - q, 3) : 0;
}

/* By a difference quotient: independent of how the kernels derive it. */
static double slope_of(double r)
{
    const double e = 1e-5;
    return (wind_ref_kernel(r + e) - wind_ref_kernel(r - e)) / (2 * e);
}

/* The distance from j to i, the kernel's gradient there; 0 if j is no neighbour. */
static int pair(const struct wind_ref_particle *i, const struct wind_ref_particle *j, double *r,
                double grad[3])
{
    double d[3], r2 = 0;
    for (int a = 0; a < 3; a++) {
        d[a] = i->x[a] - j->x[a];
        r2 += d[a] * d[a];
    }
    *r = sqrt(r2);
    if (i == j || *r >= support || *r == 0)
        return 0;
    for (int a = 0; a < 3; a++)
        grad[a] = d[a] / *r * slope_of(*r);
    return 1;
}

static double dot_difference(const double a[3], const double b[3], const double g[3])
{
    return (a[0] - b[0]) * g[0] + (a[1] - b[1]) * g[1] + (a[2] - b[2]) * g[2];
}

static struct wind_ref_result of_one(const struct wind_ref_particle *p, size_t n, size_t i)
{
    struct wind_ref_result out = {.density = wind_ref_kernel(0)};
    double squares = 0, r, g[3];
    for (size_t j = 0; j < n; j++) {
        if (!pair(&p[i], &p[j], &r, g))
            continue;
        double volume = p[j].volume,
               along = dot_difference(p[i].v, p[j].v, p[i].x) - dot_difference(p[i].v, p[j].v, p[j].x);
        out.neighbours++;
        out.density += volume * wind_ref_kernel(r);
        out.compression += volume * dot_difference(p[i].v, p[j].v, g);
        if (p[j].kind == REF_AIR)
            squares += volume * volume * (g[0] * g[0] + g[1] * g[1] + g[2] * g[2]);
        for (int a = 0; a < 3; a++) {
            out.crowd[a] += volume * g[a];
            out.push[a] -= volume * (p[i].pressure + p[j].pressure) * g[a];
            if (p[j].kind != REF_GROUND)
                out.drag[a] += volume * along / (r * r + 0.01 * support * support) * g[a];
        }
    }
    double sum = squares;
    for (int a = 0; a < 3; a++)
        sum += out.crowd[a] * out.crowd[a];
    out.factor = sum > 1e-6 ? 1 / sum : 0;
    return out;
}

void wind_ref(const struct wind_ref_particle *p, size_t n, struct wind_ref_result *out)
{
    double r, g[3];
    for (size_t i = 0; i < n; i++)
        out[i] = p[i].kind == REF_AIR ? of_one(p, n, i) : (struct wind_ref_result){0};
    for (size_t i = 0; i < n; i++) {
        out[i].left = out[i].compression;
        for (size_t j = 0; j < n; j++)
            if (p[i].kind == REF_AIR && pair(&p[i], &p[j], &r, g))
                out[i].left += p[j].volume * dot_difference(out[i].push, out[j].push, g);
    }
}

double wind_ref_volume(const struct wind_ref_particle *p, size_t n, size_t i)
{
    double sum = wind_ref_kernel(0), r, g[3];
    for (size_t j = 0; j < n; j++)
        if (p[j].kind >= REF_ROCK && pair(&p[i], &p[j], &r, g))
            sum += wind_ref_kernel(r);
    return 0.7 / sum;
}

/* Through a face of cell c towards its neighbour o on an axis, along that axis; phi's slope may change it if `free`. */
static double through(const enum wind_ref_kind *cell, const double *phi, size_t c, size_t o, double wind,
                      int side, int *free_face)
{
    *free_face = cell[c] == REF_AIR && cell[o] == REF_AIR;
    if (cell[o] == REF_ROCK || cell[o] == REF_GROUND)
        return 0;
    return *free_face ? wind - side * (phi[o] - phi[c]) : wind;
}

/* Each cell in turn sets its own balance right (Gauss and Seidel). Returns the largest imbalance it met. */
static double balance(const int n[3], const enum wind_ref_kind *cell, const double wind[3], double *phi,
                      double (*v)[3])
{
    const size_t stride[3] = {1, (size_t)n[0], (size_t)n[0] * (size_t)n[1]};
    double worst = 0;
    for (size_t c = 0; c < stride[2] * (size_t)n[2]; c++) {
        double gain = 0;
        int faces = 0;
        if (cell[c] != REF_AIR)
            continue;
        for (int a = 0; a < 3; a++) {
            v[c][a] = 0;
            for (int side = -1; side <= 1; side += 2) {
                int is_free = 0;
                if (a == 2 && side < 0 && c < stride[2])
                    continue; /* the ground */
                double flow =
                    through(cell, phi, c, side < 0 ? c - stride[a] : c + stride[a], wind[a], side, &is_free);
                gain -= side * flow;
                v[c][a] += 0.5 * flow;
                faces += is_free;
            }
        }
        worst = fmax(worst, fabs(gain));
        if (faces)
            phi[c] += gain / faces;
    }
    return worst;
}

void wind_ref_potential(const int n[3], const enum wind_ref_kind *cell, const double wind[2], double (*v)[3])
{
    const double along[3] = {wind[0], wind[1], 0};
    double *phi = calloc((size_t)n[0] * (size_t)n[1] * (size_t)n[2], sizeof *phi);
    for (int sweep = 0; phi && sweep < 20000 && balance(n, cell, along, phi, v) > 1e-9; sweep++)
        ;
    free(phi);
}
