#include "geology/concretions.h"

#include <math.h>

#include "base/vector.h"
#include "geology/attitude.h"
#include "geology/chance.h"

/* The purposes of a concretion's random numbers. */
enum { COUNT, PLACE, RADIUS = PLACE + 3 };

/* Radii are limited to so many standard deviations from the mean. */
static const double most_spread = 2;

/* The concretions of a set in one of its cubes. */
struct cube {
    const struct job_concretion *job;
    double side;
    uint32_t seed;
    int64_t at[3];
    int n;
};

static double largest(const struct job_concretion *c)
{
    return c->radius_m * exp(most_spread * c->spread) * fmax(1, 1 / c->flatten);
}

double concretions_cube(const struct job_concretion *c, double *count)
{
    const double side = fmax(cbrt(1 / c->per_m3), largest(c));
    *count = c->per_m3 * side * side * side;
    return side;
}

static uint32_t seed_of(const struct job *job, size_t i)
{
    return chance_seed(job->seed, job->concretions[i].seed, (uint32_t)i, RANDOM_CONCRETIONS);
}

/* The number of concretions in the cube, by inversion of the cumulative Poisson distribution. */
static struct cube cube_at(const struct job *job, size_t i, double side, double mean, const int64_t at[3])
{
    const uint32_t seed = random_hash(seed_of(job, i), (uint32_t)at[0], (uint32_t)at[1], (uint32_t)at[2]);
    struct cube c = {&job->concretions[i], side, seed, {at[0], at[1], at[2]}, 0};
    const double u = chance(seed, 0, 0, COUNT);
    double term = exp(-mean), sum = term;
    while (u > sum && c.n < 1000) {
        c.n++;
        term *= mean / c.n;
        sum += term;
    }
    return c;
}

/* The centre and the level radius of concretion k. */
static void concretion(const struct cube *c, int k, double out[4])
{
    for (int a = 0; a < 3; a++)
        out[a] = c->side * ((double)c->at[a] + chance(c->seed, k + 1, 0, PLACE + (uint32_t)a));
    const double spread = c->job->spread, z = chance_normal(c->seed, k + 1, 0, RADIUS);
    out[3] = c->job->radius_m * exp(spread * fmin(fmax(z, -most_spread), most_spread));
}

/* Marks the subcells, DEEP on a side, of a cube of width h around x that have their centre in the ellipsoid. */
enum { DEEP = 4 };

static uint64_t parts_in(const double e[4], double flatten, const double up[3], const double x[3], double h)
{
    uint64_t in = 0;
    const double far = e[3] * fmax(1, 1 / flatten) + h;
    if (fabs(x[0] - e[0]) > far || fabs(x[1] - e[1]) > far || fabs(x[2] - e[2]) > far)
        return 0;
    for (int i = 0; i < DEEP * DEEP * DEEP; i++) {
        const int at[3] = {i % DEEP, i / DEEP % DEEP, i / DEEP / DEEP};
        double d[3];
        for (int a = 0; a < 3; a++)
            d[a] = x[a] + ((at[a] + 0.5) / DEEP - 0.5) * h - e[a];
        const double high = dot3(up, d), square = dot3(d, d) + (flatten * flatten - 1) * high * high;
        in |= (uint64_t)(square <= e[3] * e[3]) << i;
    }
    return in;
}

static void cubes_of(double side, const double low[3], const double high[3], int64_t from[3], int64_t to[3])
{
    for (int a = 0; a < 3; a++) {
        from[a] = (int64_t)floor(low[a] / side);
        to[a] = (int64_t)floor(high[a] / side);
    }
}

/* Runs BODY for each cube `c` that a box overlaps. */
#define EACH_CUBE(job, i, low, high, BODY)                                                                   \
    do {                                                                                                     \
        int64_t from[3], to[3], at[3];                                                                       \
        double mean, side = concretions_cube(&(job)->concretions[i], &mean);                                 \
        cubes_of(side, low, high, from, to);                                                                 \
        for (at[2] = from[2]; at[2] <= to[2]; at[2]++)                                                       \
            for (at[1] = from[1]; at[1] <= to[1]; at[1]++)                                                   \
                for (at[0] = from[0]; at[0] <= to[0]; at[0]++) {                                             \
                    const struct cube c = cube_at(job, i, side, mean, at);                                   \
                    BODY                                                                                     \
                }                                                                                            \
    } while (0)

double concretions_hardness(const struct job *job, const double x[3], double height, double h)
{
    double up[3], hardness = 1;
    attitude_up(job, up);
    for (size_t i = 0; i < job->n_concretions; i++) {
        const struct job_concretion *set = &job->concretions[i];
        const double reach = largest(set) + h;
        double low[3], high[3];
        uint64_t in = 0;
        if (!(set->per_m3 > 0) || height < set->from_m || height >= set->to_m)
            continue;
        for (int a = 0; a < 3; a++) {
            low[a] = x[a] - reach;
            high[a] = x[a] + reach;
        }
        EACH_CUBE(job, i, low, high, {
            for (int k = 0; k < c.n; k++) {
                double e[4];
                concretion(&c, k, e);
                in |= parts_in(e, set->flatten, up, x, h);
            }
        });
        hardness *= 1 + (set->hardness - 1) * __builtin_popcountll(in) / (DEEP * DEEP * DEEP);
    }
    return hardness;
}

size_t concretions_in(const struct job *job, size_t i, const double low[3], const double high[3],
                      double (*out)[4], size_t most)
{
    size_t n = 0;
    EACH_CUBE(job, i, low, high, {
        for (int k = 0; k < c.n; k++) {
            double e[4];
            bool in = true;
            concretion(&c, k, e);
            for (int a = 0; a < 3; a++)
                in &= e[a] >= low[a] && e[a] < high[a];
            for (int v = 0; v < 4 && in && n < most; v++)
                out[n][v] = e[v];
            n += in;
        }
    });
    return n;
}
