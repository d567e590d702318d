#include "geology/beds.h"

#include <stdlib.h>

#include "base/memory.h"
#include "geology/chance.h"
#include "geology/lead.h"

/* The purposes of a bed's random numbers. */
enum { THICKNESS, HARDNESS, AZIMUTH, LAMINA };

/* More beds than this are a typing error. */
#define MOST_BEDS 4000000

/* ---- the table */

static status add(struct beds *b, double top, double hardness)
{
    status st = OK;
    size_t capacity = b->capacity;
    TRY(memory_grow(&b->edge, &capacity, b->n + 2, sizeof *b->edge, "beds"));
    capacity = b->capacity;
    TRY(memory_grow(&b->sum, &capacity, b->n + 2, sizeof *b->sum, "beds"));
    TRY(memory_grow(&b->hardness, &b->capacity, b->n + 2, sizeof *b->hardness, "beds"));
    b->hardness[b->n] = hardness;
    b->sum[b->n + 1] = b->sum[b->n] + hardness * (top - b->edge[b->n]);
    b->edge[++b->n] = top;
done:
    return st;
}

/* Adds beds up to `top`, of this hardness except for markers in them. */
static status lay(struct beds *b, const struct job_bedding *pile, double top, double hardness)
{
    status st = OK;
    for (size_t i = 0; i < pile->n_markers; i++) {
        const struct job_marker *m = &pile->markers[i];
        const double foot = fmax(m->at_m, b->edge[b->n]), head = fmin(m->at_m + m->thickness_m, top);
        if (head <= foot)
            continue;
        if (foot > b->edge[b->n])
            TRY(add(b, foot, hardness));
        TRY(add(b, head, m->hardness));
    }
    if (top > b->edge[b->n])
        TRY(add(b, top, hardness));
done:
    return st;
}

/* ---- one bed */

struct pile {
    const struct job_bedding *job;
    uint32_t seed;
    double origin; /* m: the foot of bed 0 */
    double mean;   /* of exp(s z), by thickness */
};

/* The modified Bessel function of order 0: the mean of exp(x sin) over a period. */
static double bessel_i0(double x)
{
    double term = 1, sum = 1;
    for (int k = 1; k < 40; k++) {
        term *= x * x / (4.0 * k * k);
        sum += term;
    }
    return sum;
}

static double rhythm_of(const struct job_bedding *b)
{
    return b->rhythm_m > 0 ? b->rhythm : 0;
}

static struct pile pile_of(const struct job *job, size_t i)
{
    const struct job_bedding *b = &job->strata_from[i];
    const double r = b->correlation, s = b->hardness_spread, q = rhythm_of(b);
    return (struct pile){
        .job = b,
        .seed = chance_seed(job->seed, b->seed, (uint32_t)i, RANDOM_BEDS),
        .origin = b->from_m > -1e6 ? b->from_m : 0,
        .mean = exp(r * s * b->thickness_spread + s * s / 2 * (r * r + (1 - r * r) * (1 - q))) *
                bessel_i0(s * sqrt((1 - r * r) * 2 * q)),
    };
}

static double thickness_of(const struct pile *p, int64_t i)
{
    const double s = p->job->thickness_spread;
    return p->job->thickness_m * exp(s * chance_normal(p->seed, i, 0, THICKNESS) - s * s / 2);
}

static double hardness_of(const struct pile *p, int64_t i, double middle)
{
    const struct job_bedding *b = p->job;
    const double r = b->correlation, q = rhythm_of(b);
    const double swing = q > 0 ? sqrt(2 * q) * sin(2 * M_PI * middle / b->rhythm_m) : 0;
    const double z = r * chance_normal(p->seed, i, 0, THICKNESS) +
                     sqrt(1 - r * r) * (sqrt(1 - q) * chance_normal(p->seed, i, 0, HARDNESS) + swing);
    return exp(b->hardness_spread * z) / p->mean;
}

/* Adds the part of the bed from `foot` to `top` that is above the table's end and below `high`. */
static status lay_bed(struct beds *beds, const struct pile *p, int64_t i, double foot, double top,
                      double high)
{
    status st = OK;
    const double hardness = hardness_of(p, i, (foot + top) / 2), seam = fmin(foot + p->job->parting_m, top);
    if (seam > beds->edge[beds->n])
        TRY(lay(beds, p->job, fmin(seam, high), hardness / p->job->parting));
    if (top > beds->edge[beds->n])
        TRY(lay(beds, p->job, fmin(top, high), hardness));
done:
    return st;
}

/* ---- a sequence */

/* Adds a measured section, from the foot of the sequence. */
static status lay_column(struct beds *beds, const struct pile *p, double high)
{
    status st = OK;
    double top = p->origin;
    for (size_t i = 0; i < p->job->n_column && top < high; i++) {
        top += p->job->column[i][0];
        if (top > beds->edge[beds->n])
            TRY(lay(beds, p->job, fmin(top, high), p->job->column[i][1]));
    }
    if (high > beds->edge[beds->n])
        TRY(lay(beds, p->job, high, 1));
done:
    return st;
}

/* Adds the generated beds between two heights, of which the table has reached the lower. */
static status lay_pile(struct beds *beds, const struct pile *p, double low, double high)
{
    status st = OK;
    if (p->job->n_column)
        return lay_column(beds, p, high);
    int64_t i = 0;
    double foot = p->origin;
    while (foot > low) {
        foot -= thickness_of(p, --i);
        if (i < -MOST_BEDS)
            goto many;
    }
    for (double top; foot < high; foot = top, i++) {
        top = foot + thickness_of(p, i);
        if (i > MOST_BEDS)
            goto many;
        if (top > low)
            TRY(lay_bed(beds, p, i, foot, top, high));
    }
done:
    return st;
many:
    return fail(
        E_USAGE,
        "strata_from: more than %d beds of %g m lie between height %g m and the domain: make thickness_m larger, or from_m nearer",
        MOST_BEDS, p->job->thickness_m, p->origin);
}

status beds_create(const struct job *job, double low, double high, struct beds *b)
{
    status st = OK;
    *b = (struct beds){0};
    if (job->n_strata_from == 0)
        return OK;
    b->capacity = 64;
    TRY(memory_alloc(b->capacity, sizeof *b->edge, "beds", &b->edge));
    TRY(memory_alloc(b->capacity, sizeof *b->sum, "beds", &b->sum));
    TRY(memory_alloc(b->capacity, sizeof *b->hardness, "beds", &b->hardness));
    b->edge[0] = low;
    for (size_t i = 0; i < job->n_strata_from; i++) {
        const struct pile p = pile_of(job, i);
        const double from = fmax(p.job->from_m, low), to = fmin(p.job->to_m, high);
        if (to <= from)
            continue;
        if (from > b->edge[b->n])
            TRY(add(b, from, 1));
        TRY(lay_pile(b, &p, from, to));
    }
done:
    if (st != OK)
        beds_destroy(b);
    return st;
}

void beds_destroy(struct beds *b)
{
    free(b->edge);
    free(b->sum);
    free(b->hardness);
    *b = (struct beds){0};
}

/* ---- queries */

/* The segment that contains a height between the first edge and the last. */
static size_t segment(const struct beds *b, double height)
{
    size_t low = 0, high = b->n - 1;
    while (low < high) {
        const size_t middle = (low + high + 1) / 2;
        if (b->edge[middle] <= height)
            low = middle;
        else
            high = middle - 1;
    }
    return low;
}

static double sum_to(const struct beds *b, double height)
{
    if (height <= b->edge[0])
        return height - b->edge[0];
    if (height >= b->edge[b->n])
        return b->sum[b->n] + height - b->edge[b->n];
    const size_t i = segment(b, height);
    return b->sum[i] + b->hardness[i] * (height - b->edge[i]);
}

double beds_hardness(const struct beds *b, double low, double high, double *along)
{
    double rates = high - low;
    *along = 1;
    if (b->n == 0)
        return 1;
    const size_t first = segment(b, fmin(fmax(low, b->edge[0]), b->edge[b->n]));
    for (size_t i = first; i < b->n && b->edge[i] < high; i++) {
        const double part = fmin(high, b->edge[i + 1]) - fmax(low, b->edge[i]);
        rates += part > 0 ? part * (pow(b->hardness[i], -LEAD_POWER) - 1) : 0;
    }
    *along = pow(rates / (high - low), -1.0 / LEAD_POWER);
    return (sum_to(b, high) - sum_to(b, low)) / (high - low);
}

/* ---- cross-bedding */

/* Up to this many laminae across a voxel are evaluated; the mean of more is close enough to 1. */
enum { LAMINAE = 64 };

static double lamina_hardness(const struct job_cross *c, uint32_t seed, int64_t set, int64_t lamina)
{
    return exp(c->spread * chance_normal(seed, set, lamina, LAMINA) - c->spread * c->spread / 2);
}

double beds_cross(const struct job *job, const double x[3], double height, double h)
{
    size_t i = 0;
    while (i < job->n_strata_from && height >= job->strata_from[i].to_m)
        i++;
    if (i == job->n_strata_from || height < job->strata_from[i].from_m)
        return 1;
    const struct job_cross *c = &job->strata_from[i].cross;
    if (!(c->set_m > 0) || c->spread == 0 || h > LAMINAE * c->lamina_m)
        return 1;
    const struct pile p = pile_of(job, i);
    const int64_t set = (int64_t)floor((height - p.origin) / c->set_m);
    const double azimuth =
        (c->azimuth_deg + c->azimuth_spread_deg * chance_normal(p.seed, set, 0, AZIMUTH)) * (M_PI / 180);
    double down = cos(azimuth) * x[0] + sin(azimuth) * x[1];
    if (c->trough_m > 0) {
        const double across = cos(azimuth) * x[1] - sin(azimuth) * x[0], turn = across / c->trough_m;
        const double off = (turn - floor(turn + 0.5)) * c->trough_m; /* from the trough's axis */
        down -= off * off / c->trough_m;
    }
    const double foreset = c->foreset_deg * (M_PI / 180);
    const double at = sin(foreset) * down + cos(foreset) * (height - p.origin), low = at - h / 2,
                 high = at + h / 2;
    double sum = 0;
    for (int64_t k = (int64_t)floor(low / c->lamina_m); (double)k * c->lamina_m < high; k++)
        sum += lamina_hardness(c, p.seed, set, k) *
               (fmin(high, (double)(k + 1) * c->lamina_m) - fmax(low, (double)k * c->lamina_m));
    return h / sum;
}
