#include "render/show.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "job/palette.h"

static const struct value_legend *legend(enum value_id show)
{
    return &value_table[show].legend;
}

static bool logarithmic(enum value_id show)
{
    return legend(show)->axis == AXIS_LOG;
}

static bool diverging(enum value_id show)
{
    return legend(show)->axis == AXIS_DIVERGING;
}

const char *show_words(char out[SHOW_WORDS])
{
    const char *name[VALUES];
    const size_t n = value_names(IN_SHOW, name);
    strcpy(out, "rock");
    for (size_t i = 0; i < n; i++) {
        strcat(out, "|");
        strcat(out, name[i]);
    }
    return out;
}

enum value_id show_of_word(int word)
{
    const char *name[VALUES];
    const size_t n = value_names(IN_SHOW, name);
    return word > 0 && (size_t)word <= n ? value_of_name(name[word - 1]) : VALUE_NONE;
}

/* ---- ranges */

/* Rounds to two significant digits, away from zero (up) or towards it. */
static double two_digits(double x, bool up)
{
    if (x == 0 || !isfinite(x))
        return x;
    double unit = pow(10, floor(log10(fabs(x))) - 1);
    double n = up == (x > 0) ? ceil(fabs(x) / unit - 1e-9) : floor(fabs(x) / unit + 1e-9);
    return copysign(n * unit, x);
}

/* From the slowest strong rate to the fastest weak rate, in whole decades, since noise and paint change them slightly. */
static struct show_range rates(const struct job *job)
{
    double low = INFINITY, high = 0;
    for (size_t i = 0; i < job->n_strata; i++) {
        double weak = curve_max(&job->strata[i].weak_m_per_kyr) * curve_max(&job->strata_scale.rates),
               strong = job_strong(job, i, job->frames.first);
        high = fmax(high, fmax(weak, strong));
        if (strong > 0)
            low = fmin(low, strong);
        if (weak > 0)
            low = fmin(low, weak);
    }
    if (!(high > 0))
        return (struct show_range){1e-3, 1};
    low = pow(10, floor(log10(low) + 1e-9));
    high = pow(10, ceil(log10(high) - 1e-9));
    return (struct show_range){low, fmax(high, 10 * low)};
}

struct show_range show_job_range(enum value_id show, const struct job *job)
{
    double weight_MPa = job->rock.density_kg_m3 * job->rock.gravity_m_s2 * job->domain.size_m[2] * 1e-6;
    double water = job->domain.size_m[0] * job->domain.size_m[1] * curve_max(&job->rain.m_per_yr);
    if (!(weight_MPa > 0))
        weight_MPa = 1;
    switch (legend(show)->span) {
    case SPAN_STRESS: {
        /* Compression concentrates at the foot of rock, and rock in tension does not last. */
        double most = two_digits(1.5 * weight_MPa, true);
        return (struct show_range){-0.2 * most, most};
    }
    case SPAN_WEIGHT:
        return (struct show_range){0, two_digits(weight_MPa, true)};
    case SPAN_WATER:
        for (size_t i = 0; i < job->n_sources; i++)
            water += curve_max(&job->sources[i].m3_per_yr);
        return (struct show_range){1, fmax(10, pow(10, ceil(log10(fmax(water, 1)) - 1e-9)))};
    case SPAN_RATES:
        return rates(job);
    case SPAN_LAYERS:
        return (struct show_range){0, fmax((double)palette_size(job) - 1, 1)};
    case SPAN_FIXED:
        break;
    }
    return (struct show_range){legend(show)->low, legend(show)->high};
}

static int ascending(const void *a, const void *b)
{
    float x = *(const float *)a, y = *(const float *)b;
    return (x > y) - (x < y);
}

struct show_range show_data_range(enum value_id show, float *values, size_t n)
{
    struct show_range r = {0, 1};
    size_t first = 0;
    qsort(values, n, sizeof *values, ascending);
    /* On a logarithmic scale, ignore zeros: most of the surface is dry. */
    while (logarithmic(show) && first < n && values[first] < 1e-6F)
        first++;
    if (first < n) {
        size_t count = n - first;
        r.low = two_digits((double)values[first + count / 100] * legend(show)->scale, false);
        r.high = two_digits((double)values[n - 1 - count / 100] * legend(show)->scale, true);
    }
    if (diverging(show)) /* the range includes zero */
        r = (struct show_range){fmin(r.low, 0), fmax(r.high, 0)};
    if (logarithmic(show))
        r.low = fmax(r.low, 1e-6);
    if (!(r.high > r.low))
        r.high = r.low + (logarithmic(show) ? 9 * r.low : 1);
    return r;
}

status show_parse_range(enum value_id show, const char *text, struct show_range *out)
{
    char *end = NULL;
    struct show_range r;
    r.low = strtod(text, &end);
    bool good = end != text && *end == ':';
    const char *second = good ? end + 1 : text;
    r.high = strtod(second, &end);
    good = good && end != second && *end == '\0';
    if (!good || !isfinite(r.low) || !isfinite(r.high) || !(r.low < r.high) || fabs(r.low) > 1e12 ||
        fabs(r.high) > 1e12 || r.high - r.low < 1e-9)
        return fail(E_USAGE,
                    "--range %.40s: write LO:HI%s%s, LO less than HI, such as 0:1.5; or job, or data", text,
                    *legend(show)->unit ? " in " : "", legend(show)->unit);
    if (logarithmic(show) && r.low <= 0)
        return fail(E_USAGE, "--range %.40s: %s has a logarithmic scale, so LO must be above 0", text,
                    value_table[show].name);
    *out = r;
    return OK;
}

/* ---- colours */

double show_position(enum value_id show, struct show_range r, double value)
{
    double t;
    if (logarithmic(show))
        t = value > r.low ? log(value / r.low) / log(r.high / r.low) : 0;
    else
        t = (value - r.low) / (r.high - r.low);
    return t > 0 ? fmin(t, 1) : 0; /* NaN maps to the low end */
}

static void between(const unsigned char (*stop)[3], int n, double t, unsigned char rgb[3])
{
    double x = fmin(fmax(t, 0), 1) * (n - 1);
    int i = (int)fmin(floor(x), n - 2);
    for (int k = 0; k < 3; k++)
        rgb[k] = (unsigned char)lrint(stop[i][k] + (x - i) * (stop[i + 1][k] - stop[i][k]));
}

void show_color(enum value_id show, struct show_range r, double position, unsigned char rgb[3])
{
    /* viridis (van der Walt and Smith), and Moreland's diverging cool-warm map. */
    static const unsigned char
        viridis[][3] = {{68, 1, 84},    {72, 40, 120},  {62, 73, 137},  {49, 104, 142}, {38, 130, 142},
                        {31, 158, 137}, {53, 183, 121}, {109, 205, 89}, {180, 222, 44}, {253, 231, 37}},
        cool[][3] = {{221, 221, 221}, {184, 208, 249}, {141, 176, 254}, {98, 130, 234}, {59, 76, 192}},
        warm[][3] = {{221, 221, 221}, {245, 196, 173}, {244, 154, 123}, {222, 96, 77}, {180, 4, 38}};
    if (!diverging(show)) {
        between(viridis, 10, position, rgb);
        return;
    }
    double value = r.low + position * (r.high - r.low);
    if (value < 0)
        between(cool, 5, value / fmin(r.low, 0), rgb);
    else
        between(warm, 5, r.high > 0 ? value / r.high : 0, rgb);
}

/* ---- ticks of the legend */

/* The number of decimals that steps of this size need. */
static void short_number(double x, double step, char out[16])
{
    static const char *const unit[] = {"", "k", "M", "G"};
    int k = 0;
    for (; fabs(x) >= 999.5 && k < 3; k++) {
        x /= 1000;
        step /= 1000;
    }
    int decimals = (int)fmin(fmax(ceil(-log10(step) - 1e-9), 0), 9);
    snprintf(out, 16, "%.*f%s", decimals, x, unit[k]);
}

static size_t decades(struct show_range r, struct show_tick tick[SHOW_TICKS])
{
    size_t n = 0;
    int first = (int)ceil(log10(r.low) - 1e-9), last = (int)floor(log10(r.high) + 1e-9);
    int every = 1 + (last - first) / (SHOW_TICKS - 1);
    for (int d = first; d <= last && n < SHOW_TICKS; d += every) {
        tick[n].position = log(pow(10, d) / r.low) / log(r.high / r.low);
        short_number(pow(10, d), pow(10, d), tick[n++].text);
    }
    return n;
}

size_t show_ticks(enum value_id show, struct show_range r, struct show_tick tick[SHOW_TICKS])
{
    size_t n = 0;
    if (logarithmic(show) && r.high >= 10 * r.low)
        return decades(r, tick);
    double span = r.high - r.low, step = pow(10, floor(log10(span / 3)));
    step *= span / step > 12 ? 5 : span / step > 6 ? 2 : 1;
    if (value_table[show].kind == KIND_ID && span >= 1) /* between whole numbers there is nothing */
        step = fmax(step, 1);
    for (double k = ceil(r.low / step - 1e-9); k * step <= r.high + 1e-9 * span && n < SHOW_TICKS; k++) {
        tick[n].position = show_position(show, r, k * step);
        short_number(k == 0 ? 0 : k * step, step, tick[n++].text);
    }
    return n;
}
