#include "look/live.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/log.h"
#include "render/page_parts.h"

/* The finite number in a parameter of the request, or `preset`. */
static double number(const struct serve_request *r, const char *name, double preset)
{
    const char *text = serve_value(r, name);
    char *end;
    const double value = text ? strtod(text, &end) : preset;
    return text && (*end || end == text || !isfinite(value)) ? preset : value;
}

static void give_text(struct text *t, const char *type, struct serve_answer *out)
{
    if (text_status(t) != OK) {
        text_free(t);
        return;
    }
    *out = (struct serve_answer){.code = 200, .type = type, .bytes = t->data, .n = t->size};
    *t = (struct text){0};
}

static void give_page(struct serve_answer *out)
{
    struct text t = {0};
    for (const char *const *line = page_look; *line; line++)
        text_add(&t, "%s", *line);
    give_text(&t, "text/html; charset=utf-8", out);
}

/* Answers with the error message, which the page shows. */
static void give_failure(struct live *l, status st, struct serve_answer *out)
{
    struct text t = {0};
    const bool theirs = st == E_USAGE || st == E_INPUT || st == E_NUMERIC || st == E_MEMORY || st == STOPPED;
    text_add(&t, "%s", status_message());
    give_text(&t, "text/plain; charset=utf-8", out);
    out->code = theirs ? 422 : 500;
    if (!theirs) {
        l->broken = st;
        snprintf(l->message, sizeof l->message, "%s", status_message());
    }
}

/* ---- the job */

static void list_values(struct text *t)
{
    json_array(t, "values");
    for (int v = 1; v < VALUES; v++)
        if ((value_table[v].where & IN_SHOW) && value_table[v].channel[0]) {
            json_object(t, NULL);
            json_text(t, "name", value_table[v].name);
            json_text(t, "unit", value_table[v].legend.unit);
            json_end_object(t);
        }
    json_end_array(t);
}

static void give_job(struct live *l, struct serve_answer *out)
{
    const struct sketch_options *s = &l->options->sketch;
    struct job *job = NULL;
    struct text t = {0};
    const bool hushed = log_silence(true);
    const status st = sketch_read_job(s, &job);
    log_silence(hushed);
    json_object(&t, NULL);
    json_integer(&t, "saves", l->saves);
    if (st == OK) {
        json_text(&t, "name", job->name);
        json_integer(&t, "first", job->frames.first);
        json_integer(&t, "last", job->frames.last);
        json_array(&t, "size_m");
        for (int a = 0; a < 3; a++)
            json_number(&t, NULL, job->domain.size_m[a]);
        json_end_array(&t);
        json_array(&t, "cameras");
        for (size_t i = 0; i < job->n_cameras; i++)
            json_text(&t, NULL, job->cameras[i].name);
        json_end_array(&t);
        list_values(&t);
    } else {
        json_text(&t, "error", status_message());
    }
    json_end_object(&t);
    job_destroy(&job);
    give_text(&t, "application/json", out);
}

/* ---- pictures */

/* Range, colours and ticks of the legend. */
static void add_legend(struct text *t, enum value_id show, struct show_range range)
{
    enum { COLORS = 24 };
    struct show_tick tick[SHOW_TICKS];
    const size_t n = show_ticks(show, range, tick);
    json_object(t, "legend");
    json_text(t, "unit", value_table[show].legend.unit);
    json_array(t, "colors");
    for (int i = 0; i < COLORS; i++) {
        unsigned char rgb[3];
        char text[8];
        show_color(show, range, i / (COLORS - 1.0), rgb);
        snprintf(text, sizeof text, "#%02x%02x%02x", rgb[0], rgb[1], rgb[2]);
        json_text(t, NULL, text);
    }
    json_end_array(t);
    json_array(t, "ticks");
    for (size_t i = 0; i < n; i++) {
        json_object(t, NULL);
        json_number(t, "at", tick[i].position);
        json_text(t, "text", tick[i].text);
        json_end_object(t);
    }
    json_end_array(t);
    json_end_object(t);
}

/* The header X-Look must be ASCII on one line; the texts in it are. */
static char *note_of(const struct look_made *m, enum value_id show)
{
    struct text t = {0};
    json_object(&t, NULL);
    json_integer(&t, "frame", m->frame);
    json_number(&t, "years", m->years);
    json_number(&t, "spacing_m", m->spacing_m);
    json_number(&t, "job_spacing_m", m->own_spacing_m);
    json_integer(&t, "particles", (int64_t)m->n_particles);
    json_integer(&t, "job_particles", (int64_t)m->own_estimate.n_particles);
    json_number(&t, "job_seconds", m->own_seconds);
    json_integer(&t, "job_bytes", (int64_t)(m->own_estimate.device_bytes + m->own_estimate.host_bytes));
    json_integer(&t, "from_frame", m->began);
    json_number(&t, "seconds", round(100 * (m->load_seconds + m->step_seconds + m->picture_seconds)) / 100);
    if (show)
        add_legend(&t, show, m->range);
    json_end_object(&t);
    json_one_line(&t);
    while (t.size && t.data[t.size - 1] == '\n')
        t.data[--t.size] = '\0';
    return t.data;
}

static enum value_id shown(const struct serve_request *r)
{
    const char *name = serve_value(r, "show");
    const enum value_id value = name ? value_of_name(name) : VALUE_NONE;
    return (value_table[value].where & IN_SHOW) && value_table[value].channel[0] ? value : VALUE_NONE;
}

static void give_picture(struct live *l, const struct serve_request *r, struct serve_answer *out)
{
    struct look_options o = *l->options;
    struct look_made made;
    const bool rough = number(r, "rough", 0) > 0;
    const char *gizmos = serve_value(r, "gizmos");
    o.no_slate = o.no_legend = true; /* the page draws the legend */
    o.sketch.frame = serve_value(r, "frame");
    o.sketch.camera = serve_value(r, "camera");
    o.sketch.zoom = fmin(fmax(number(r, "zoom", 1), 0.1), 50);
    o.sketch.show = shown(r);
    o.sketch.all_layers = true;
    o.sketch.width = (int)fmin(fmax(number(r, "width", o.sketch.width), 64), 1920) / (rough ? 2 : 1);
    o.sketch.samples = rough ? 1 : o.sketch.samples;
    o.range = NULL;
    o.cut = serve_value(r, "cut");
    o.figure = number(r, "figure", 0) > 0;
    o.gizmos = gizmos && strcmp(gizmos, "all") == 0    ? GIZMOS_ALL
               : gizmos && strcmp(gizmos, "none") == 0 ? GIZMOS_NONE
                                                       : GIZMOS_NOW;
    const status st = look_make(l->look, &o, &made);
    if (st != OK) {
        give_failure(l, st, out);
        return;
    }
    *out = (struct serve_answer){.code = 200,
                                 .type = "image/png",
                                 .bytes = made.png,
                                 .n = made.png_size,
                                 .note = note_of(&made, o.sketch.show)};
    made.png = NULL;
    look_made_free(&made);
}

static void give_place(struct live *l, const struct serve_request *r, struct serve_answer *out)
{
    struct text t = {0};
    json_object(&t, NULL);
    look_at(l->look, number(r, "x", 0.5), number(r, "y", 0.5), &t);
    json_end_object(&t);
    give_text(&t, "application/json", out);
}

static void give_curves(struct live *l, struct serve_answer *out)
{
    struct text t = {0};
    json_object(&t, NULL);
    const status st = look_curves(l->look, &t);
    json_end_object(&t);
    if (st == OK)
        give_text(&t, "application/json", out);
    else
        give_failure(l, st, out);
    text_free(&t);
}

void live_answer(void *user, const struct serve_request *r, struct serve_answer *out)
{
    struct live *l = user;
    const char *path = serve_path(r);
    if (strcmp(path, "/") == 0)
        give_page(out);
    else if (strcmp(path, "/job") == 0)
        give_job(l, out);
    else if (strcmp(path, "/picture") == 0)
        give_picture(l, r, out);
    else if (strcmp(path, "/curves") == 0)
        give_curves(l, out);
    else if (strcmp(path, "/at") == 0)
        give_place(l, r, out);
}
