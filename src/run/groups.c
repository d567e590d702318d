#include "run/groups.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>

#include "text/json.h"
#include "text/text.h"

struct scale {
    const struct job *job;
    int frame;              /* the frame in the middle, for curves */
    double low[3], high[3]; /* m: bounds of the rock */
    double half;            /* m: half of its smaller width */
    double kyr;
};

struct range {
    double from, to; /* 0: no bound */
};

static double three_digits(double x)
{
    if (!(x > 0) || !isfinite(x))
        return x;
    const double unit = pow(10, floor(log10(x)) - 2);
    return unit < 1 ? round(x / unit) / round(1 / unit) : round(x / unit) * unit;
}

static void add(struct text *t, const char *name, const char *formula, double value, struct range forms,
                const char *format, ...) PRINTF_LIKE(6, 7);
static void add(struct text *t, const char *name, const char *formula, double value, struct range forms,
                const char *format, ...)
{
    char says[400];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(says, sizeof says, format, arguments);
    va_end(arguments);
    json_object(t, NULL);
    json_text(t, "group", name);
    json_text(t, "formula", formula);
    json_number(t, "value", three_digits(value));
    json_number(t, "forms_from", forms.from);
    json_number(t, "forms_to", forms.to);
    json_text(t, "says", says);
    json_end_object(t);
}

static const char *stand(double value, struct range forms, const char *below, const char *within,
                         const char *above)
{
    return value < forms.from ? below : forms.to > 0 && value > forms.to ? above : within;
}

/* ---- arenite */

/* The stratum whose threshold is nearest to the weight above its foot. */
static void add_interlocking(const struct scale *s, struct text *t)
{
    static const struct range forms = {0.4, 2};
    const struct job *job = s->job;
    const double metre = 1e-6 * job->rock.density_kg_m3 * job->rock.gravity_m_s2; /* MPa */
    double below = -INFINITY, nearest = INFINITY, stress = 0, height = 0;
    for (size_t i = 0; i < job->n_strata; i++) {
        const double bottom = fmax(below, s->low[2]), above = s->high[2] - bottom;
        below = job->strata[i].to_m;
        if (bottom >= fmin(below, s->high[2]) || above <= 0)
            continue;
        const double ratio = job_interlock(job, i, s->frame) / (metre * above);
        if (ratio < nearest) {
            nearest = ratio;
            stress = job_interlock(job, i, s->frame);
            height = above;
        }
    }
    if (!isfinite(nearest) || !(metre > 0))
        return;
    if (nearest > 1)
        add(t, "interlocking", "I / (density g H)", nearest, forms,
            "interlocking holds from %.3g m of rock upwards; nothing in this scene is that high (%.3g m): %s",
            stress / metre, height,
            nearest <= forms.to ? "only legs that carry more than the column above them hold"
                                : "interlocking plays no part");
    else
        add(t, "interlocking", "I / (density g H)", nearest, forms,
            "interlocking holds from %.3g m of rock upwards, of %.3g m: %s", stress / metre, height,
            stand(nearest, forms, "most rock interlocks from the start, and erosion stops early",
                  "arches and pillars hold", ""));
}

/* How fast rock of a stratum retreats, as a share of its weak rate: in goblins, as a ball of half the rock's width (voxels/README.md). */
static double share_of_weak(const struct scale *s, size_t stratum)
{
    if (job_model(s->job)->interlocks)
        return 1;
    return 1 - s->job->goblins.threshold + 0.375 * s->job->strata[stratum].bubble.radius_m / s->half;
}

static void add_retreat(const struct scale *s, struct text *t)
{
    static const struct range forms = {0.1, 6}, lasts = {0, 0.5};
    double weak = 0, strong = 0;
    for (size_t i = 0; i < s->job->n_strata; i++) {
        weak = fmax(weak, job_weak(s->job, i, s->frame) * share_of_weak(s, i));
        strong = fmax(strong, job_strong(s->job, i, s->frame));
    }
    const double far = weak * s->kyr / s->half;
    add(t, "retreat", "R t / (W / 2)", far, forms,
        "bare rock retreats %.3g m in %.4g kyr; half the width of the rock is %.3g m: %s", weak * s->kyr,
        s->kyr, s->half,
        stand(far, forms, "too little for forms, unless water or paint makes them", "enough for forms",
              "little is left long before the end, unless it is sheltered or interlocks"));
    if (!job_model(s->job)->interlocks)
        return;
    const double slow = strong * s->kyr / s->half;
    add(t, "endurance", "k_s t / (W / 2)", slow, lasts, "interlocked rock retreats %.3g m in that time: %s",
        strong * s->kyr,
        stand(slow, lasts, "", "what interlocks outlasts the job", "what interlocks is worn away too"));
}

static void add_wind(const struct scale *s, struct text *t)
{
    static const struct range feels = {0.05, 0}, sided = {0, 4};
    const struct job *job = s->job;
    const struct job_deflation *d = &job->wind.deflation;
    const double foot = 1e-6 * job->rock.density_kg_m3 * job->rock.gravity_m_s2 * (s->high[2] - s->low[2]);
    const double pull = d->cohesion_MPa + d->friction * foot,
                 gale = curve_at(&job->wind.speed_m_s, s->frame) / job->wind.reference_m_s;
    const double plucked = curve_at(&d->intensity, s->frame),
                 rubbed = curve_at(&job->wind.abrasion, s->frame) * gale * gale;
    if (plucked > 0)
        add(t, "deflation", "mu_f T / alpha", d->friction * foot / d->strength_MPa, feels,
            "at the foot, under %.3g MPa, the wind plucks %.2g of what it plucks from unstressed rock", foot,
            exp(-(pull * pull - d->cohesion_MPa * d->cohesion_MPa) /
                (2 * d->strength_MPa * d->strength_MPa)));
    if (plucked > 0 && rubbed > 0)
        add(t, "abrasion", "R_a / R_d", rubbed / plucked, sided,
            "a face to the wind loses %.3g to blown sand for each 1 that is plucked from any face: %s",
            rubbed / plucked,
            stand(rubbed / plucked, (struct range){0.25, 2}, "all sides weather alike",
                  "the windward side weathers faster", "only the windward side weathers much"));
}

/* The slope from which on water cuts, by the erosion law without its limit on slopes. */
static void add_water(const struct scale *s, struct text *t)
{
    static const struct range cuts = {0.5, 0};
    const struct job_rain *r = &s->job->rain;
    const double threshold = curve_at(&r->threshold_Pa, s->frame), length = 2 * s->half;
    double q = curve_at(&r->m_per_yr, s->frame) * length;
    const char *from = "rain on a slope as long as the rock is wide";
    for (size_t i = 0; i < s->job->n_sources; i++) {
        const double Q = curve_at(&s->job->sources[i].m3_per_yr, s->frame);
        const double width = fmax(r->least_width_m, r->width_m * pow(Q, r->width_power));
        if (Q > 0 && Q / width > q) {
            q = Q / width;
            from = "the largest source";
        }
    }
    if (!(q > 0) || !(threshold > 0))
        return;
    const double shear = r->pull_Pa * pow(q, 0.6), steep = pow(threshold / fmax(shear, 1e-300), 1 / 0.7);
    if (steep > r->steepest)
        add(t, "water", "k_f q^0.6 / tau_c", shear / threshold, cuts,
            "%s (%.3g m2/yr) cuts nothing: it would need a slope of %.3g, and rain.steepest is %.3g", from, q,
            steep, r->steepest);
    else
        add(t, "water", "k_f q^0.6 / tau_c", shear / threshold, cuts,
            "%s (%.3g m2/yr) cuts where it is steeper than %.2g (%.2g degrees)", from, q, steep,
            180 / 3.14159265358979 * atan(steep));
}

/* ---- goblins */

static void add_bubbles(const struct scale *s, struct text *t)
{
    static const struct range rounds = {0.05, 1};
    double least = INFINITY, most = 0;
    for (size_t i = 0; i < s->job->n_strata; i++) {
        least = fmin(least, s->job->strata[i].bubble.radius_m);
        most = fmax(most, s->job->strata[i].bubble.radius_m);
    }
    const double ratio = most / s->half;
    add(t, "bubble", "r / (W / 2)", ratio, rounds, "bubbles of %.3g m in rock of half width %.3g m: %s", most,
        s->half,
        stand(ratio, rounds, "only edges are rounded before the faces retreat",
              "corners and edges are rounded while the faces retreat",
              "all of the rock feels the air at once"));
}

void groups_describe(const struct job *job, const struct scene_size *size, struct text *t)
{
    struct scale s = {.job = job,
                      .frame = (job->frames.first + job->frames.last) / 2,
                      .kyr = 1e-3 * job_years(job, job->frames.first, job->frames.last)};
    scene_bounds(size, s.low, s.high);
    s.half = fmin(s.high[0] - s.low[0], s.high[1] - s.low[1]) / 2;
    s.job = job_at(job, s.frame);
    if (job_model(job)->terrain || size->n_points == 0 || !(s.half > 0) || !(s.kyr > 0) ||
        job->clock.seconds_per_frame > 0)
        return;
    json_array(t, "groups");
    if (job_model(job)->interlocks) {
        add_interlocking(&s, t);
        add_retreat(&s, t);
        add_wind(&s, t);
        add_water(&s, t);
    } else {
        add_retreat(&s, t);
        add_bubbles(&s, t);
    }
    json_end_array(t);
}
