#include "tests/ref/stream_ref.h"

#include <assert.h>
#include <math.h>
#include <stdlib.h>

#include "shared/params.h"

static const int step_x[4] = {1, 0, -1, 0}, step_y[4] = {0, 1, 0, -1};

/* What one floor has to spread. */
struct source {
    double radius, weights, width; /* cells, their sum, m */
    double rain[2], spring[2];     /* m3/yr times their way */
    double rains, springs, sheet;  /* the last along its way */
    double line[2];                /* cells: from here to the stream's middle */
};

struct all {
    const struct flow_ref *f;
    const struct job_rain *how;
    const uint32_t *level;
    double h, narrowest, deep; /* m, m, cells */
    struct source *source;
};

static size_t cell(const struct flow_ref *f, int x, int y, int z)
{
    return ((size_t)z * (size_t)f->cells[1] + (size_t)y) * (size_t)f->cells[0] + (size_t)x;
}

static bool is_open(const struct flow_ref *f, size_t c)
{
    const uint32_t kind = f->tag[c] & WATER_KIND;
    return kind == WATER_EMPTY || kind == WATER_SURF;
}

static bool is_floor(const struct flow_ref *f, size_t c)
{
    return is_open(f, c) && f->floor[c] == c;
}

static bool is_ground(const struct flow_ref *f, size_t c)
{
    return c < (size_t)f->cells[0] * (size_t)f->cells[1] && (f->tag[c] & WATER_KIND) == WATER_EMPTY;
}

static void place_of(const struct flow_ref *f, size_t c, int at[3])
{
    at[0] = (int)(c % (size_t)f->cells[0]);
    at[1] = (int)(c / (size_t)f->cells[0] % (size_t)f->cells[1]);
    at[2] = (int)(c / ((size_t)f->cells[0] * (size_t)f->cells[1]));
}

static uint32_t level_of(const struct all *a, size_t c)
{
    return a->level[c] == UINT32_MAX ? a->f->altitude[c] : a->level[c];
}

/* The floor of column (x, y) that is beside height z, r cells away; SIZE_MAX: there is rock. */
static size_t seen(const struct all *a, int x, int y, int z, double r)
{
    const struct flow_ref *f = a->f;
    for (int at = z; at <= z + ceil(a->deep + r) && at < f->cells[2]; at++)
        if (is_open(f, cell(f, x, y, at)))
            return f->floor[cell(f, x, y, at)];
    return SIZE_MAX;
}

static double spread(const struct all *a, size_t from, size_t to, double r, double radius)
{
    const double rise = fabs((double)level_of(a, from) - (double)level_of(a, to)) / 65536;
    return rise <= a->deep + r && r < radius ? 1 - r * r / (radius * radius) : 0;
}

/* Takes a place behind a wall back to this side, whose image it is; `flip` turns ways around. False beyond an open side. */
static bool seen_at(const struct flow_ref *f, int at[2], double flip[2])
{
    const unsigned low[2] = {WALL_X_MIN, WALL_Y_MIN}, high[2] = {WALL_X_MAX, WALL_Y_MAX};
    for (int i = 0; i < 2; i++) {
        const bool under = at[i] < 0 && (f->walls & low[i]),
                   over = at[i] >= f->cells[i] && (f->walls & high[i]);
        at[i] = under ? -1 - at[i] : over ? 2 * f->cells[i] - 1 - at[i] : at[i];
        flip[i] = under || over ? -1 : 1;
    }
    return at[0] >= 0 && at[1] >= 0 && at[0] < f->cells[0] && at[1] < f->cells[1];
}

/* The floors around c, itself included, out to `reach` cells. */
#define EACH_FLOOR(a, c, reach, ...)                                                                         \
    do {                                                                                                     \
        int p_[3];                                                                                           \
        place_of((a)->f, c, p_);                                                                             \
        for (int y = p_[1] - (reach); y <= p_[1] + (reach); y++)                                             \
            for (int x = p_[0] - (reach); x <= p_[0] + (reach); x++) {                                       \
                int at_[2] = {x, y};                                                                         \
                double flip[2] = {1, 1};                                                                     \
                if (!seen_at((a)->f, at_, flip))                                                             \
                    continue;                                                                                \
                const double dx = x - p_[0], dy = y - p_[1], r = hypot(dx, dy);                              \
                const size_t m = r == 0 ? (c) : seen(a, at_[0], at_[1], p_[2], r);                           \
                (void)flip;                                                                                  \
                if (m != SIZE_MAX)                                                                           \
                    __VA_ARGS__                                                                              \
            }                                                                                                \
    } while (0)

static void outward(const struct flow_ref *f, size_t c, double way[2])
{
    int at[3];
    place_of(f, c, at);
    const unsigned low[2] = {WALL_X_MIN, WALL_Y_MIN}, high[2] = {WALL_X_MAX, WALL_Y_MAX};
    for (int k = 0; k < 2; k++)
        way[k] = (at[k] == f->cells[k] - 1 && !(f->walls & high[k])) - (at[k] == 0 && !(f->walls & low[k]));
    const double sum = fmax(1, fabs(way[0]) + fabs(way[1]));
    way[0] /= sum;
    way[1] /= sum;
}

/* The way of springs, and of rain: by how much lower the water beside it stands. */
static void ways_of(const struct all *a, size_t c, bool leak, double rain[2], double spring[2])
{
    const struct flow_ref *f = a->f;
    int at[3];
    double drop[4] = {0}, sum = 0;
    place_of(f, c, at);
    rain[0] = rain[1] = spring[0] = spring[1] = 0;
    if (f->tag[c] & WATER_OUT) {
        outward(f, c, spring);
    } else {
        const bool drips = leak && at[2] > 0 && (f->tag[cell(f, at[0], at[1], at[2] - 1)] & WATER_KIND) == 0;
        for (int d = 0; d < 4; d++) {
            const int x = at[0] + step_x[d], y = at[1] + step_y[d];
            if (x < 0 || y < 0 || x >= f->cells[0] || y >= f->cells[1] || !is_open(f, cell(f, x, y, at[2])))
                continue;
            const size_t m = f->floor[cell(f, x, y, at[2])];
            if (m == f->receiver[c]) {
                spring[0] = step_x[d];
                spring[1] = step_y[d];
            }
            if (!drips && level_of(a, c) == f->altitude[c] && level_of(a, m) < level_of(a, c))
                sum += drop[d] = (double)level_of(a, c) - (double)level_of(a, m);
        }
    }
    rain[0] = sum > 0 ? (drop[0] - drop[2]) / sum : spring[0];
    rain[1] = sum > 0 ? (drop[1] - drop[3]) / sum : spring[1];
}

/* How far a spring's stream is beside a cell, by a line through this one and its next steps. */
static void beside_line(const struct flow_ref *f, size_t c, double line[2])
{
    enum { HALF = 4 };
    double sum[2][2] = {{0}}, far = 0, along = 0;
    int from[3], at[3];
    place_of(f, c, from);
    line[0] = line[1] = 0;
    for (int step = 0; step < 2 * HALF; step++) {
        place_of(f, c, at);
        for (int k = 0; k < 2; k++)
            sum[step / HALF][k] += (double)(at[k] - from[k]) / HALF;
        if (f->tag[c] & WATER_OUT && step + 1 < 2 * HALF)
            return;
        c = f->receiver[c];
    }
    for (int k = 0; k < 2; k++) {
        const double ahead = sum[1][k] - sum[0][k];
        far += ahead * ahead;
        along += ahead * (sum[0][k] + sum[1][k]) / 2;
    }
    for (int k = 0; k < 2 && far > 0; k++)
        line[k] = (sum[0][k] + sum[1][k]) / 2 - (sum[1][k] - sum[0][k]) * along / far;
    const double off = fmax(1, hypot(line[0], line[1]));
    for (int k = 0; k < 2; k++)
        line[k] = round(line[k] / off * 32767) / 32767; /* as it is kept */
}

static struct source source_of(const struct all *a, size_t c, bool leak, double rain, double spring)
{
    const double q = rain + spring;
    struct source s = {
        .width = fmax(a->how->least_width_m, q > 0 ? a->how->width_m * pow(q, a->how->width_power) : 0),
        .rains = rain,
        .springs = spring};
    s.radius = 8 / (3 * acos(-1)) * fmax(s.width, a->narrowest) / a->h;
    ways_of(a, c, leak, s.rain, s.spring);
    s.sheet = rain * hypot(s.rain[0], s.rain[1]);
    for (int k = 0; k < 2; k++) {
        s.rain[k] *= rain;
        s.spring[k] *= spring;
    }
    if (spring > 0)
        beside_line(a->f, c, s.line);
    if (q > 0)
        EACH_FLOOR(a, c, (int)(s.radius + 1),
                   { s.weights += spread(a, c, m, hypot(dx - s.line[0], dy - s.line[1]), s.radius); });
    return s;
}

/* What a place r cells away weighs in a slope, in the mean over a cell's width by Simpson's rule. */
static double weight_in(double r, double window)
{
    double sum = 0;
    for (int i = -1; i <= 1; i++)
        sum += (i ? 1 : 4) * fmax(0, 1 - pow((r + i / 2.0) / window, 2)) / 6;
    return sum;
}

/* The slope along a way, from the water abreast to the water below, or from that above where the domain ends below; *far, cells,
 * is how far it is there. */
static double slope_along(const struct all *a, size_t c, const double way[2], double *far)
{
    const double window = fmax(a->how->slope_m / 2, 1.5 * a->h) / a->h, steepest = a->how->steepest;
    const double own = a->source[c].rains + a->source[c].springs;
    double abreast[3] = {0}, below[3] = {0}; /* weights, and those of places and of rises */
    EACH_FLOOR(a, c, (int)(window + 0.5), {
        const double along = dx * way[0] + dy * way[1];
        const double rise = ((double)level_of(a, m) - (double)level_of(a, c)) / 65536;
        const double up = fmax(-steepest * r, fmin(steepest * r, rise));
        const double runs = a->source[m].rains + a->source[m].springs;
        const double water = weight_in(r, window) * (is_ground(a->f, m) ? fmax(runs, own) : runs);
        int behind[2] = {2 * p_[0] - x, 2 * p_[1] - y};
        const bool ends = along < 0 && !seen_at(a->f, behind, flip);
        const double side = ends ? -1 : 1, weight = along > 0 || ends ? water * fabs(along) : 0;
        const double beside = water * fmax(0, 1 - fabs(along));
        abreast[0] += beside;
        abreast[1] += beside * along;
        abreast[2] += beside * up;
        below[0] += weight;
        below[1] += weight * side * along;
        below[2] += weight * side * up;
    });
    *far = 1;
    if (!(abreast[0] > 0) || !(below[0] > 0))
        return 0;
    *far = fmax(0.5, below[1] / below[0] - abreast[1] / abreast[0]);
    return fmax(0, fmin(steepest, (abreast[2] / abreast[0] - below[2] / below[0]) / *far));
}

/* The slope of what falls off a floor, to whatever side. */
static double slope_of_falls(const struct all *a, size_t c)
{
    const double window = fmax(a->how->slope_m / 2, 1.5 * a->h) / a->h, steepest = a->how->steepest;
    double squares = 0, far = 0;
    EACH_FLOOR(a, c, (int)(window + 0.5), {
        const double near = weight_in(r, window);
        const double fall = fmin(steepest * r, ((double)level_of(a, c) - (double)level_of(a, m)) / 65536);
        if (near > 0 && fall > 0) {
            squares += near * fall * fall;
            far += near * (dx * dx + dy * dy) / 2;
        }
    });
    return far > 0 ? fmin(steepest, sqrt(squares / far)) : 0;
}

static double shear(const struct all *a, double q, double slope)
{
    return a->how->pull_Pa * pow(fmax(q, 0), 0.6) * pow(slope, 0.7);
}

static struct stream_ref pull_of(const struct all *a, size_t c, int reach)
{
    struct stream_ref result = {.share = 1};
    double rain[2] = {0}, spring[2] = {0}, springs = 0, sheet = 0, narrow = 0, wide = 0, all = 0;
    EACH_FLOOR(a, c, reach, {
        const struct source *s = &a->source[m];
        const double off = hypot(dx + flip[0] * s->line[0], dy + flip[1] * s->line[1]);
        const double weight = s->weights > 0 ? spread(a, m, c, off, s->radius) / s->weights / a->h : 0;
        const double shown = fmax(s->width, a->narrowest);
        for (int k = 0; k < 2; k++) {
            rain[k] += weight * flip[k] * s->rain[k];
            spring[k] += weight * flip[k] * s->spring[k];
        }
        sheet += weight * s->sheet;
        springs += weight * s->springs;
        narrow += weight * s->springs * fmin(1, s->width / shown);
        wide += weight * (s->rains + s->springs) * shown;
        all += weight * (s->rains + s->springs);
    });
    const double flows = hypot(rain[0] + spring[0], rain[1] + spring[1]);
    if (!(flows > 0))
        return result;
    const double way[2] = {(rain[0] + spring[0]) / flows, (rain[1] + spring[1]) / flows};
    const double depth = ((double)level_of(a, c) - (double)a->f->altitude[c]) / 65536 / a->deep;
    const double together = sheet > 0 ? fmin(hypot(rain[0], rain[1]) / sheet, 1) : 1;
    double far;
    const double along = slope_along(a, c, way, &far), run = hypot(spring[0], spring[1]);
    const double slope = springs > 0 ? along : together * along + (1 - together) * slope_of_falls(a, c);
    result.drop = slope * far * a->h;
    result.share = springs > 0 ? narrow / springs : 1;
    result.beside = fmax(0, 1 - depth) * shear(a, sheet, slope);
    result.stream = fmax(0, 1 - depth) * shear(a, run / result.share + sheet, slope);
    result.shown = (run + sheet) * wide / all;
    return result;
}

struct stream_ref *stream_ref_pull(const struct flow_ref *f, const struct job_rain *how, double h,
                                   const uint32_t *level, const double *rain, const double *spring)
{
    struct all a = {.f = f,
                    .how = how,
                    .level = level,
                    .h = h,
                    .narrowest = 1.5 * h,
                    .deep = fmax(1, how->least_width_m / 2 / h)};
    struct stream_ref *result = calloc(f->n, sizeof *result);
    double widest = 0;
    a.source = calloc(f->n, sizeof *a.source);
    assert(a.source && result);
    for (size_t c = 0; c < f->n; c++)
        if (is_floor(f, c)) {
            a.source[c] = source_of(&a, c, how->leak, rain[c], spring[c]);
            widest = fmax(widest, a.source[c].radius);
        }
    for (size_t c = 0; c < f->n; c++)
        if (is_floor(f, c))
            result[c] = pull_of(&a, c, (int)ceil(widest) + 1);
    free(a.source);
    return result;
}
