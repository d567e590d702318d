/* The page of a run: head, problems and pictures. */
#include <ctype.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include "base/version.h"
#include "render/page_parts.h"
#include "render/report_page.h"
#include "render/template.h"
#include "system/progress.h"

enum { MOST_TROUBLES = 12 };

/* ---- texts and members */

struct phrase phrase(const char *format, ...)
{
    struct phrase w;
    va_list args;
    va_start(args, format);
    vsnprintf(w.text, sizeof w.text, format, args);
    va_end(args);
    return w;
}

struct phrase phrase_number(double value)
{
    char number[48];
    return phrase("%s", html_number(value, number));
}

struct phrase phrase_bytes(uint64_t bytes)
{
    static const char *const units[] = {"B", "kB", "MB", "GB", "TB"};
    double value = (double)bytes;
    int unit = 0;
    for (; value >= 1000 && unit < 4; unit++)
        value /= 1000;
    return phrase("%s %s", phrase_number(value).text, units[unit]);
}

struct phrase phrase_age(double years)
{
    if (years >= 1000)
        return phrase("%.*f kyr", years < 9995 ? 2 : 1, years / 1000);
    if (years > 0 && years < 1)
        return phrase("%s days", phrase_number(365.25 * years).text);
    return phrase("%s yr", phrase_number(years).text);
}

void page_members(struct text *t, const char *const *pairs)
{
    for (; *pairs; pairs += 2)
        json_text(t, pairs[0], pairs[1]);
}

double page_number(const struct json *object, const char *key)
{
    const struct json *number = json_member(object, key);
    return number && number->kind == JSON_NUMBER && isfinite(number->number) ? number->number : 0;
}

void page_chart(struct text *t, const char *key, struct text *svg)
{
    t->failed |= svg->failed;
    json_text(t, key, svg->data ? svg->data : "");
    text_free(svg);
}

/* ---- the head */

static const struct report_frame *sound(const struct report *r, bool last)
{
    for (size_t i = 0; i < r->n_frames; i++) {
        const struct report_frame *f = &r->frame[last ? r->n_frames - 1 - i : i];
        if (!f->damaged)
            return f;
    }
    return NULL;
}

static void add_head(const struct report *r, struct text *t)
{
    char range[48];
    const size_t total = range_count(r->frames);
    PAGE_MEMBERS(t, "root", r->root, "frames", range_text(r->frames, range), "pace",
                 phrase_age(r->job->clock.years_per_frame).text, "fps", phrase("%g", r->job->fps).text,
                 "owner", r->job->output.owner, "comments", r->job->output.comments, "n_sound",
                 phrase("%zu", r->n_sound).text, "n_frames", phrase("%zu", total).text, "n_damaged",
                 r->n_damaged ? phrase("%zu", r->n_damaged).text : "");
    json_bool(t, "complete", r->n_sound == total);
    json_bool(t, "nothing_sound", r->n_sound == 0);
}

static void add_tile(struct text *t, const char *name, struct phrase value, struct phrase small)
{
    PAGE_ROW(t, NULL, "tile", name, "value", value.text, "small", small.text);
}

static void add_last_tiles(const struct report *r, const struct manifest *m, struct text *t)
{
    struct phrase samples = phrase("%s", job_model(r->job)->samples);
    samples.text[0] = (char)toupper((unsigned char)samples.text[0]);
    add_tile(t, "Weathered for", phrase_age(m->years), phrase("at frame %d", m->frame));
    if (m->start_volume_m3 > 0)
        add_tile(t, "Rock left", phrase("%.1f %%", 100 * m->volume_m3 / m->start_volume_m3),
                 phrase("%s m³", phrase_number(m->volume_m3).text));
    if (m->max_stress_Pa > 0)
        add_tile(t, "Greatest stress", phrase("%s MPa", phrase_number(m->max_stress_Pa / 1e6).text),
                 phrase("compression"));
    add_tile(t, samples.text, phrase_number((double)m->ledger.start),
             phrase("at the start, every %s m", phrase_number(r->job->domain.spacing_m).text));
}

static void add_tiles(const struct report *r, struct text *t)
{
    char duration[48];
    const struct report_frame *last = sound(r, true);
    double wall = 0;
    json_array(t, "tiles");
    add_tile(t, "Frames done", phrase("%zu", r->n_sound), phrase("of %zu", range_count(r->frames)));
    if (last)
        add_last_tiles(r, &last->manifest, t);
    for (size_t i = 0; i < r->n_timing; i++)
        wall += page_number(r->timing[i], "wall_seconds");
    if (wall > 0)
        add_tile(t, "Time taken", phrase("%s", duration_text(wall, duration)),
                 phrase("in %zu session%s", r->n_timing, r->n_timing == 1 ? "" : "s"));
    if (r->disk)
        add_tile(t, "On disk", phrase_bytes(r->disk), phrase("all frames"));
    json_end_array(t);
}

/* ---- problems */

static void add_missing(const struct report *r, struct text *t)
{
    const char *comma = "";
    size_t k = 0;
    json_object(t, "missing");
    PAGE_MEMBERS(t, "n", phrase("%zu", r->n_missing).text, "are", r->n_missing == 1 ? " is" : "s are");
    json_array(t, "ranges");
    for (int f = r->frames.first; f <= r->frames.last; f += r->frames.step) {
        int last = f;
        while (k < r->n_frames && r->frame[k].manifest.frame < f)
            k++;
        if (k < r->n_frames && r->frame[k].manifest.frame == f)
            continue;
        while (last + r->frames.step <= r->frames.last &&
               !(k < r->n_frames && r->frame[k].manifest.frame == last + r->frames.step))
            last += r->frames.step;
        PAGE_ROW(t, NULL, "comma", comma, "range",
                 (last > f ? phrase("%d\xe2\x80\x93%d", f, last) : phrase("%d", f)).text);
        comma = ", ";
        f = last;
    }
    json_end_array(t);
    json_end_object(t);
}

static void add_troubles(const struct report *r, struct text *t)
{
    size_t said = 0;
    json_array(t, "damaged");
    for (size_t i = 0; i < r->n_frames && said < MOST_TROUBLES; i++)
        if (r->frame[i].damaged) {
            PAGE_ROW(t, NULL, "frame", phrase("%d", r->frame[i].manifest.frame).text, "what",
                     r->frame[i].what);
            said++;
        }
    json_end_array(t);
    if (r->n_damaged > said)
        json_integer(t, "n_more_damaged", (int64_t)(r->n_damaged - said));
    if (r->n_missing)
        add_missing(r, t);
    page_lines(t, "notes", r->notes.data);
}

/* ---- pictures */

static void add_pictured(struct text *t, const char *key, const struct report_frame *f)
{
    PAGE_ROW(t, key, "frame", phrase("%d", f->manifest.frame).text, "age",
             phrase_age(f->manifest.years).text);
}

static void add_turntable(const struct report *r, struct text *t)
{
    if (r->video)
        PAGE_ROW(t, "video", "poster", r->n_views ? "yes" : "");
    else if (r->n_views > 0)
        PAGE_ROW(t, "orbit", "frame", phrase("%d", r->turntable_frame).text, "n_views",
                 phrase("%d", r->n_views).text, "last_view",
                 r->n_views > 1 ? phrase("%d", r->n_views - 1).text : "");
    else
        json_bool(t, "no_turntable", true);
}

static void add_contact_sheet(const struct report *r, struct text *t)
{
    json_object(t, "contact_sheet");
    json_array(t, "thumbs");
    for (size_t i = 0; i < r->n_frames; i++)
        if (r->frame[i].thumb)
            add_pictured(t, NULL, &r->frame[i]);
    json_end_array(t);
    json_end_object(t);
}

static void add_pictures(const struct report *r, struct text *t)
{
    const struct report_frame *first = NULL, *last = NULL;
    size_t n_thumbs = 0;
    bool exist = false;
    for (size_t i = 0; i < r->n_frames; i++) {
        exist |= *r->frame[i].source.text != '\0';
        n_thumbs += r->frame[i].thumb;
        if (!r->frame[i].pictured)
            continue;
        first = first ? first : &r->frame[i];
        last = &r->frame[i];
    }
    json_bool(t, "plain_pictures", first && !r->stills);
    json_bool(t, "no_pictures", !first && !exist);
    json_bool(t, "left_out", !first && exist);
    if (first != last) {
        json_object(t, "slider");
        add_pictured(t, "before", first);
        add_pictured(t, "after", last);
        json_end_object(t);
    } else if (first) {
        add_pictured(t, "only_picture", first);
    }
    add_turntable(r, t);
    if (n_thumbs >= 2)
        add_contact_sheet(r, t);
}

/* ---- the page */

void page_lines(struct text *t, const char *key, char *text)
{
    json_array(t, key);
    while (text && *text) {
        char *end = text + strcspn(text, "\n"), kept = *end;
        *end = '\0';
        json_text(t, NULL, text);
        *end = kept;
        text = end + (kept == '\n');
    }
    json_end_array(t);
}

static void add_embedded(struct text *t, const char *key, const char *const *lines)
{
    struct text whole = {0};
    for (; *lines; lines++)
        text_add_bytes(&whole, *lines, strlen(*lines));
    page_chart(t, key, &whole);
}

status page_fill(const char *name, struct text *t, struct text *out)
{
    status st = OK;
    struct json *data = NULL;
    json_text(t, "name", name);
    json_text(t, "version", hoodoo_version);
    json_text(t, "commit", hoodoo_commit);
    add_embedded(t, "style", page_style);
    add_embedded(t, "script", page_script);
    json_end_object(t);
    TRY(text_status(t));
    TRY(json_read(NULL, t->data, t->size, &data));
    template_fill(page_report, data, out);
    TRY(text_status(out));
done:
    if (data)
        json_free(&data);
    text_free(t);
    return st;
}

status report_page(const struct report *r, struct text *out)
{
    status st = text_status(&r->notes);
    struct text t = {0};
    if (st != OK)
        return st;
    json_object(&t, NULL);
    json_object(&t, "run");
    add_head(r, &t);
    add_tiles(r, &t);
    add_troubles(r, &t);
    add_pictures(r, &t);
    if (sound(r, false) != sound(r, true))
        page_curves(r, &t);
    else
        page_rock(r, &t);
    page_timing(r, &t);
    page_provenance(r, &t);
    page_files(r, &t);
    json_end_object(&t);
    return page_fill(r->name, &t, out);
}
