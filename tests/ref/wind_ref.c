#include "wind_ref.h"

#include <math.h>

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
