/* Curves over time from manifests, and stress and layers from the files of the last frame. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "base/memory.h"
#include "job/palette.h"
#include "render/report_page.h"

/* Different in lightness as well as in hue. */
static const char ROCK[] = "#a9491f", DEPOSIT[] = "#e8bd52", FALLEN[] = "#2f5f8a", LEFT[] = "#d9d3ca";

enum column { TIME, VOLUME, RATE, STRESS, N_ROCK, N_DEPOSIT, N_FALLEN, N_LEFT, N_COLUMNS };

struct columns {
    size_t n; /* sound frames */
    double *value[N_COLUMNS];
    struct page_clock clock;
};

struct page_clock page_clock(const struct report *r)
{
    struct page_clock c = {.label = "time, yr", .rate = "kyr", .unit = 1, .per = 0.001};
    if (r->job->clock.seconds_per_frame > 0)
        c = (struct page_clock){.label = "time, s", .rate = "s", .unit = 1, .per = 1, .shot = true};
    for (size_t i = r->n_frames; i-- > 0;)
        if (!r->frame[i].damaged)
            c.began =
                r->frame[i].manifest.years - job_years(r->job, r->frames.first, r->frame[i].manifest.frame);
    if (!c.shot && c.began + job_years(r->job, r->frames.first, r->frames.last) >= 2000)
        c = (struct page_clock){
            .label = "time, kyr", .rate = "kyr", .unit = 1000, .per = 1, .began = c.began};
    c.now = r->mark ? page_time(r, &c, *r->mark) : (double)NAN;
    return c;
}

double page_time(const struct report *r, const struct page_clock *clock, int frame)
{
    const double passed = clock->shot ? (frame - r->frames.first) * r->job->clock.seconds_per_frame
                                      : clock->began + job_years(r->job, r->frames.first, frame);
    return passed / clock->unit;
}

static void fill(const struct report *r, struct columns *c)
{
    const struct manifest *before = NULL;
    for (size_t i = 0; i < r->n_frames; i++) {
        const struct manifest *m = &r->frame[i].manifest;
        if (r->frame[i].damaged)
            continue;
        const size_t k = c->n++;
        c->value[TIME][k] = page_time(r, &c->clock, m->frame);
        c->value[VOLUME][k] = m->volume_m3;
        c->value[STRESS][k] = m->max_stress_Pa / 1e6;
        const double lasted = before ? (c->value[TIME][k] - c->value[TIME][k - 1]) * c->clock.per : 0;
        c->value[RATE][k] = lasted > 0 ? (before->volume_m3 - m->volume_m3) / lasted : (double)NAN;
        c->value[N_ROCK][k] = (double)m->ledger.rock;
        c->value[N_DEPOSIT][k] = (double)m->ledger.deposit;
        c->value[N_FALLEN][k] = (double)m->ledger.fallen;
        c->value[N_LEFT][k] = (double)m->ledger.left;
        before = m;
    }
}

static status make_columns(const struct report *r, struct columns *c)
{
    status st = OK;
    c->clock = page_clock(r);
    for (int i = 0; i < N_COLUMNS; i++)
        TRY(memory_alloc(r->n_frames, sizeof(double), "curves", &c->value[i]));
    fill(r, c);
done:
    return st;
}

static void add_part(struct text *t, const char *key, const char *name, uint64_t n, uint64_t start)
{
    PAGE_ROW(t, key, "part", name, "n", phrase_number((double)n).text, "share",
             phrase("%.2f", start ? 100 * (double)n / (double)start : 0).text);
}

static void add_ledger(const struct report *r, const struct columns *c, struct text *t)
{
    const struct ledger *l = NULL;
    struct text svg = {0};
    bool exact = true;
    int last = 0;
    const char *what = job_model(r->job)->samples;
    for (size_t i = 0; i < r->n_frames; i++)
        if (!r->frame[i].damaged) {
            l = &r->frame[i].manifest.ledger;
            last = r->frame[i].manifest.frame;
            exact &= l->start == l->rock + l->deposit + l->fallen + l->left;
        }
    const struct series series[] = {{"rock", ROCK, c->value[N_ROCK]},
                                    {"deposit", DEPOSIT, c->value[N_DEPOSIT]},
                                    {"fallen", FALLEN, c->value[N_FALLEN]},
                                    {"left the domain", LEFT, c->value[N_LEFT]}};
    const uint64_t n[] = {l->rock, l->deposit, l->fallen, l->left};
    chart_lines(&(struct chart){.title = "Where the rock went",
                                .x_label = c->clock.label,
                                .y_label = what,
                                .n = c->n,
                                .x = c->value[TIME],
                                .n_series = 4,
                                .series = series,
                                .stacked = true,
                                .mark = &c->clock.now},
                &svg);
    json_object(t, "ledger");
    page_chart(t, "ledger_chart", &svg);
    json_text(t, "what", what);
    json_bool(t, "exact", exact);
    json_integer(t, "frame", last);
    json_array(t, "parts");
    for (size_t i = 0; i < sizeof n / sizeof *n; i++)
        add_part(t, NULL, series[i].name, n[i], l->start);
    json_end_array(t);
    add_part(t, "start", "start", l->start, l->start);
    json_end_object(t);
}

/* ---- the last frame */

static void add_stress(const struct report *r, struct text *t)
{
    const struct report_stress *s = &r->stress;
    struct mark mark[2];
    size_t n_marks = 0;
    char title[160], low[48];
    double least = HUGE_VAL, most = -HUGE_VAL;
    for (size_t i = 0; i < r->job->n_strata; i++) {
        const double at = job_interlock(r->job, i, s->frame);
        least = fmin(least, at);
        most = fmax(most, at);
    }
    /* In other models, load does not affect weathering. */
    const double ends[] = {least, most};
    for (size_t i = 0; job_model(r->job)->interlocks && i < (most > least ? 2 : 1); i++)
        if (ends[i] > s->low && ends[i] < s->high) {
            mark[n_marks].x = ends[i];
            snprintf(mark[n_marks].name, sizeof mark[n_marks].name, "%s at %.30s MPa",
                     most == least ? "interlocks"
                     : i           ? "all layers interlock"
                                   : "the first layer interlocks",
                     html_number(ends[i], low));
            n_marks++;
        }
    snprintf(title, sizeof title, "Stress in frame %d", s->frame);
    chart_histogram(&(struct histogram){.title = title,
                                        .x_label = "−tr σ, MPa (compression positive)",
                                        .y_label = "share, %",
                                        .low = s->low,
                                        .high = s->high,
                                        .n = STRESS_BINS,
                                        .share = s->share,
                                        .n_marks = n_marks,
                                        .mark = mark},
                    t);
}

static void add_words(const struct report *r, struct text *t)
{
    const struct report_stress *s = &r->stress;
    PAGE_ROW(t, "stress", "frame", phrase("%d", s->frame).text, "n", phrase_number((double)s->n).text, "what",
             s->what, "low", phrase_number(s->low).text, "high", phrase_number(s->high).text, "interlocks",
             job_model(r->job)->interlocks ? "yes" : "");
}

/* Linear to sRGB, as #rrggbb. */
static void hex_color(const float rgb[3], char out[8])
{
    int value[3];
    for (int i = 0; i < 3; i++) {
        const double x = fmin(fmax((double)rgb[i], 0), 1);
        value[i] = (int)lround(255 * (x <= 0.0031308 ? 12.92 * x : 1.055 * pow(x, 1 / 2.4) - 0.055));
    }
    snprintf(out, 8, "#%02x%02x%02x", (unsigned)value[0] & 255, (unsigned)value[1] & 255,
             (unsigned)value[2] & 255);
}

enum { MOST_LAYERS = 40 };

static void add_layers(const struct report *r, struct text *t)
{
    struct row row[MOST_LAYERS];
    char color[MOST_LAYERS][8], title[160], number[48], low[48], high[48];
    size_t n = 0;
    const struct job *job = r->job;
    /* From the top down, as in the rock. */
    for (size_t i = job->n_strata; i-- > 0 && n < MOST_LAYERS;) {
        const struct report_layer *l = &r->layer[i];
        float rgb[3];
        if (l->start <= 0)
            continue;
        palette_color(job, i, rgb);
        hex_color(rgb, color[n]);
        row[n].color = color[n];
        row[n].value = l->now / l->start;
        const double from = i ? job->strata[i - 1].to_m : 0,
                     to = fmin(job->strata[i].to_m, job->domain.size_m[2]);
        snprintf(row[n].name, sizeof row[n].name, "layer %zu, %.16s to %.16s m", i, html_number(from, low),
                 html_number(to, high));
        snprintf(row[n].note, sizeof row[n].note, "%.1f %%, %.40s m³", 100 * row[n].value,
                 html_number(l->now, number));
        n++;
    }
    if (n == 0)
        return;
    snprintf(title, sizeof title, "What is left of each layer, frame %d against %d", r->layers_to,
             r->layers_from);
    chart_rows(title, "share of the layer's rock at the start", row, n, 1, t);
}

/* Either may be unknown, if files are missing or the model has no stress. */
static void add_rock(const struct report *r, const struct columns *c, struct text *t)
{
    double most = 0;
    for (size_t i = 0; c && i < c->n; i++)
        most = fmax(most, c->value[STRESS][i]);
    if (most <= 0 && r->stress.n == 0 && !r->layer)
        return;
    struct text most_chart = {0}, stress_chart = {0}, layers_chart = {0};
    if (most > 0) {
        const struct series stress = {"greatest compression, MPa", FALLEN, c->value[STRESS]};
        chart_lines(&(struct chart){.title = "Greatest stress",
                                    .x_label = c->clock.label,
                                    .y_label = "compression, MPa",
                                    .n = c->n,
                                    .x = c->value[TIME],
                                    .n_series = 1,
                                    .series = &stress,
                                    .from_zero = true,
                                    .mark = &c->clock.now},
                    &most_chart);
    }
    if (r->stress.n)
        add_stress(r, &stress_chart);
    if (r->layer)
        add_layers(r, &layers_chart);
    json_object(t, "rock");
    page_chart(t, "most_chart", &most_chart);
    page_chart(t, "stress_chart", &stress_chart);
    page_chart(t, "layers_chart", &layers_chart);
    if (r->stress.n)
        add_words(r, t);
    json_end_object(t);
}

void page_curves(const struct report *r, struct text *t)
{
    struct columns c = {0};
    if (make_columns(r, &c) != OK) {
        t->failed = true;
        goto done;
    }
    char rate_label[40];
    snprintf(rate_label, sizeof rate_label, "lost, m³ per %s", c.clock.rate);
    const struct series volume = {"rock, m³", ROCK, c.value[VOLUME]},
                        rate = {rate_label, ROCK, c.value[RATE]};
    struct chart chart = {.title = "Rock that is left",
                          .x_label = c.clock.label,
                          .y_label = "volume, m³",
                          .n = c.n,
                          .x = c.value[TIME],
                          .n_series = 1,
                          .series = &volume,
                          .from_zero = true,
                          .mark = &c.clock.now};
    struct text svg = {0};
    json_object(t, "erosion");
    json_integer(t, "frame", r->frames.first);
    json_text(t, "zero", c.clock.shot ? "second 0" : phrase("year %.10g", c.clock.began).text);
    chart_lines(&chart, &svg);
    page_chart(t, "volume_chart", &svg);
    chart.title = "How fast it goes";
    chart.y_label = rate_label;
    chart.series = &rate;
    chart_lines(&chart, &svg);
    page_chart(t, "rate_chart", &svg);
    page_budget(r, &c.clock, t);
    add_ledger(r, &c, t);
    json_end_object(t);
    add_rock(r, &c, t);
done:
    for (int i = 0; i < N_COLUMNS; i++)
        free(c.value[i]);
}

void page_rock(const struct report *r, struct text *t)
{
    add_rock(r, NULL, t);
}
