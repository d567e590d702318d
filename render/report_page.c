/* The report as HTML. Everything from the folder goes through html_text(); everything else is written here. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "base/progress.h"
#include "base/version.h"
#include "render/page_parts.h"
#include "render/report_page.h"

/* ---- words */

void page_bytes(uint64_t bytes, char out[48])
{
    static const char *const units[] = {"B", "kB", "MB", "GB", "TB"};
    double value = (double)bytes;
    int unit = 0;
    char number[48];
    for (; value >= 1000 && unit < 4; unit++)
        value /= 1000;
    snprintf(out, 48, "%.30s %s", html_number(value, number), units[unit]);
}

void page_age(double years, char out[48])
{
    char number[48];
    if (years >= 1000)
        snprintf(out, 48, "%.*f kyr", years < 9995 ? 2 : 1, years / 1000);
    else
        snprintf(out, 48, "%.30s yr", html_number(years, number));
}

/* A path as an address relative to the page, which is one folder down. */
void page_link(struct text *t, const char *path, const char *words)
{
    text_add(t, "<a href=\"../");
    for (const unsigned char *p = (const unsigned char *)path; *p; p++)
        if ((*p >= 'a' && *p <= 'z') || (*p >= 'A' && *p <= 'Z') || (*p >= '0' && *p <= '9') ||
            strchr("_-./", *p))
            text_add(t, "%c", *p);
        else
            text_add(t, "%%%02X", *p);
    text_add(t, "\">");
    html_text(t, words);
    text_add(t, "</a>");
}

static const struct report_frame *first_sound(const struct report *r)
{
    for (size_t i = 0; i < r->n_frames; i++)
        if (!r->frame[i].damaged)
            return &r->frame[i];
    return NULL;
}

static const struct report_frame *last_sound(const struct report *r)
{
    for (size_t i = r->n_frames; i-- > 0;)
        if (!r->frame[i].damaged)
            return &r->frame[i];
    return NULL;
}

static void add_lines(struct text *t, const char *const *lines)
{
    for (; *lines; lines++)
        text_add_bytes(t, *lines, strlen(*lines));
}

static double session_number(const struct json *session, const char *key)
{
    const struct json *number = json_member(session, key);
    return number && number->kind == JSON_NUMBER && isfinite(number->number) ? number->number : 0;
}

/* ---- the head */

static void add_badge(const struct report *r, struct text *t)
{
    const size_t total = range_count(r->frames);
    if (r->n_damaged)
        text_add(t, "<span class=\"badge bad\">%zu damaged</span>", r->n_damaged);
    if (r->n_sound == total)
        text_add(t, "<span class=\"badge done\">complete</span>");
    else
        text_add(t, "<span class=\"badge\">%zu of %zu frames</span>", r->n_sound, total);
}

static void add_tile(struct text *t, const char *name, const char *value, const char *small)
{
    text_add(t, "<div><dt>%s</dt><dd>", name);
    html_text(t, value);
    if (*small) {
        text_add(t, " <small>");
        html_text(t, small);
        text_add(t, "</small>");
    }
    text_add(t, "</dd></div>\n");
}

static void add_tiles(const struct report *r, struct text *t)
{
    char value[64], small[96], number[48];
    const struct report_frame *last = last_sound(r);
    double wall = 0;
    text_add(t, "<dl class=\"tiles\">\n");
    snprintf(value, sizeof value, "%zu", r->n_sound);
    snprintf(small, sizeof small, "of %zu", range_count(r->frames));
    add_tile(t, "Frames done", value, small);
    if (last) {
        const struct manifest *m = &last->manifest;
        page_age(m->years, value);
        snprintf(small, sizeof small, "at frame %d", m->frame);
        add_tile(t, "Weathered for", value, small);
        if (m->start_volume_m3 > 0) {
            snprintf(value, sizeof value, "%.1f %%", 100 * m->volume_m3 / m->start_volume_m3);
            snprintf(small, sizeof small, "%.40s m³", html_number(m->volume_m3, number));
            add_tile(t, "Rock left", value, small);
        }
        if (m->max_stress_Pa > 0) {
            snprintf(value, sizeof value, "%.40s MPa", html_number(m->max_stress_Pa / 1e6, number));
            add_tile(t, "Greatest stress", value, "compression");
        }
        snprintf(value, sizeof value, "%s", html_number((double)m->ledger.start, number));
        snprintf(small, sizeof small, "at the start, every %.20s m",
                 html_number(r->job->domain.spacing_m, number));
        add_tile(t, r->job->model == MODEL_GOBLINS ? "Voxels" : "Particles", value, small);
    }
    for (size_t i = 0; i < r->n_timing; i++)
        wall += session_number(r->timing[i], "wall_seconds");
    if (wall > 0) {
        snprintf(small, sizeof small, "in %zu session%s", r->n_timing, r->n_timing == 1 ? "" : "s");
        add_tile(t, "Time taken", duration_text(wall, number), small);
    }
    if (r->disk) {
        page_bytes(r->disk, value);
        add_tile(t, "On disk", value, "all frames");
    }
    text_add(t, "</dl>\n");
}

static void add_troubles(const struct report *r, struct text *t)
{
    size_t said = 0;
    for (size_t i = 0; i < r->n_frames && said < 12; i++)
        if (r->frame[i].damaged) {
            text_add(t, "<p class=\"note bad\"><strong>Frame %d is damaged.</strong> ",
                     r->frame[i].manifest.frame);
            html_text(t, r->frame[i].what);
            text_add(t, "</p>\n");
            said++;
        }
    if (r->n_damaged > said)
        text_add(t, "<p class=\"note bad\">And %zu more damaged frames.</p>\n", r->n_damaged - said);
    if (r->n_missing) {
        text_add(t, "<p class=\"note\"><strong>%zu frame%s missing:</strong> ", r->n_missing,
                 r->n_missing == 1 ? " is" : "s are");
        size_t k = 0;
        bool first = true;
        for (int f = r->frames.first; f <= r->frames.last; f += r->frames.step) {
            int last = f;
            while (k < r->n_frames && r->frame[k].manifest.frame < f)
                k++;
            if (k < r->n_frames && r->frame[k].manifest.frame == f)
                continue;
            while (last + r->frames.step <= r->frames.last &&
                   !(k < r->n_frames && r->frame[k].manifest.frame == last + r->frames.step))
                last += r->frames.step;
            text_add(t, last > f ? "%s%d\xe2\x80\x93%d" : "%s%d", first ? "" : ", ", f, last);
            first = false;
            f = last;
        }
        text_add(
            t, ". <code>hoodoo run</code> with the same job makes exactly what is missing or damaged.</p>\n");
    }
    for (const char *line = r->notes.data; line && *line;) {
        const size_t n = strcspn(line, "\n");
        char sentence[2300];
        snprintf(sentence, sizeof sentence, "%.*s", (int)(n < 2200 ? n : 2200), line);
        text_add(t, "<p class=\"note\">");
        html_text(t, sentence);
        text_add(t, "</p>\n");
        line += n + (line[n] == '\n');
    }
}

/* ---- pictures */

static void add_img(struct text *t, const char *kind, int number, const char *format, const char *alt)
{
    text_add(t, "<img src=\"%s.", kind);
    text_add(t, format[1] == '0' ? "%03d" : "%d", number);
    text_add(t, ".jpg\" alt=\"");
    html_text(t, alt);
    text_add(t, "\">");
}

static void alt_text(const struct report *r, const struct report_frame *f, char out[512])
{
    char age[48];
    page_age(f->manifest.years, age);
    snprintf(out, 512, "%.200s, frame %d, after %.40s", r->name, f->manifest.frame, age);
}

static void add_slider(const struct report *r, const struct report_frame *a, const struct report_frame *b,
                       struct text *t)
{
    char alt[512], age_a[48], age_b[48];
    page_age(a->manifest.years, age_a);
    page_age(b->manifest.years, age_b);
    text_add(
        t,
        "<figure><figcaption>Before and after <span>(frames %d and %d; drag, or use the arrow keys)</span>"
        "</figcaption><div class=\"slider\">",
        a->manifest.frame, b->manifest.frame);
    alt_text(r, a, alt);
    add_img(t, "frame", a->manifest.frame, "%d", alt);
    text_add(t, "<div class=\"after\">");
    alt_text(r, b, alt);
    add_img(t, "frame", b->manifest.frame, "%d", alt);
    text_add(t,
             "</div><input type=\"range\" min=\"0\" max=\"100\" value=\"50\" aria-label=\"Where before ends "
             "and after "
             "begins\"><div class=\"bar\"></div><b class=\"l\">%s</b><b class=\"r\">%s</b></div></figure>\n",
             age_a, age_b);
}

static void add_turntable(const struct report *r, struct text *t)
{
    char alt[300];
    snprintf(alt, sizeof alt, "%.200s from all sides", r->name);
    if (r->video) {
        text_add(t,
                 "<figure><figcaption>Turntable</figcaption><video controls loop muted playsinline "
                 "preload=\"metadata\"%s>"
                 "<source src=\"turntable.mp4\" type=\"video/mp4\">",
                 r->n_views ? " poster=\"view.000.jpg\"" : "");
        text_add(t,
                 "This browser shows no video; <a href=\"turntable.mp4\">the file</a>.</video></figure>\n");
    } else if (r->n_views > 0) {
        text_add(
            t, "<figure class=\"orbit\"><figcaption>Turntable <span>(frame %d, %d views)</span></figcaption>",
            r->turntable_frame, r->n_views);
        add_img(t, "view", 0, "%03d", alt);
        if (r->n_views > 1)
            text_add(t, "<input type=\"range\" min=\"0\" max=\"%d\" value=\"0\" aria-label=\"Turn\">",
                     r->n_views - 1);
        text_add(t, "</figure>\n");
    }
}

static void add_how(const struct report *r, const char *what, const char *options, struct text *t)
{
    text_add(t, "<p class=\"note\">%s <code>hoodoo preview ", what);
    html_text(t, r->root);
    text_add(t, "%s</code> makes it; then <code>hoodoo report ", options);
    html_text(t, r->root);
    text_add(t, "</code> again.</p>\n");
}

static void add_pictures(const struct report *r, struct text *t)
{
    const struct report_frame *first = NULL, *last = NULL;
    char alt[512];
    size_t n_thumbs = 0;
    for (size_t i = 0; i < r->n_frames; i++) {
        n_thumbs += r->frame[i].thumb;
        if (!r->frame[i].pictured)
            continue;
        first = first ? first : &r->frame[i];
        last = &r->frame[i];
    }
    if (first && !r->stills)
        add_how(r, "These are the plain pictures of the run itself; there are none by POV-Ray yet.", "", t);
    else if (!first)
        add_how(r, "There are no pictures of the frames yet.", "", t);
    text_add(t, "<div class=\"two\">\n");
    if (first != last) {
        add_slider(r, first, last, t);
    } else if (first) {
        alt_text(r, first, alt);
        text_add(t, "<figure><figcaption>Frame %d</figcaption>", first->manifest.frame);
        add_img(t, "frame", first->manifest.frame, "%d", alt);
        text_add(t, "</figure>\n");
    }
    add_turntable(r, t);
    text_add(t, "</div>\n");
    if (!r->video && r->n_views == 0)
        add_how(r, "There is no turntable yet.", " --turntable", t);
    if (n_thumbs < 2)
        return;
    text_add(t, "<h3>Contact sheet</h3><div class=\"contact\">\n");
    for (size_t i = 0; i < r->n_frames; i++) {
        char age[48];
        if (!r->frame[i].thumb)
            continue;
        alt_text(r, &r->frame[i], alt);
        page_age(r->frame[i].manifest.years, age);
        text_add(t, "<figure>");
        add_img(t, "thumb", r->frame[i].manifest.frame, "%d", alt);
        text_add(t, "<figcaption>%d &middot; %s</figcaption></figure>\n", r->frame[i].manifest.frame, age);
    }
    text_add(t, "</div>\n");
}

/* ---- the page */

void page_begin(const char *title, struct text *t)
{
    text_add(t,
             "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
             "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
             "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; img-src 'self' "
             "file: data:; "
             "media-src 'self' file:; style-src 'unsafe-inline'; script-src 'unsafe-inline'; base-uri "
             "'none'; form-action "
             "'none'\">\n<meta name=\"generator\" content=\"hoodoo %s\">\n<link rel=\"icon\" "
             "href=\"data:,\">\n<title>",
             hoodoo_version);
    html_text(t, title);
    text_add(t, " \xe2\x80\x93 hoodoo report</title>\n<style>\n");
    add_lines(t, page_style);
    text_add(t, "</style>\n</head>\n<body>\n<header>\n<h1>");
}

void page_end(struct text *t)
{
    text_add(t,
             "</main>\n<footer>Made by hoodoo %s (%s). This folder, report/, holds all the page shows and "
             "may be moved or "
             "mailed; links to frames lead to the output folder around it.</footer>\n<script>\n",
             hoodoo_version, hoodoo_commit);
    add_lines(t, page_script);
    text_add(t, "</script>\n</body>\n</html>\n");
}

void report_page(const struct report *r, struct text *t)
{
    const struct report_frame *first = first_sound(r), *last = last_sound(r);
    char age[48], range[48];
    page_begin(r->name, t);
    html_text(t, r->name);
    add_badge(r, t);
    text_add(t, "</h1>\n<p class=\"sub\">");
    text_add(t, "Frames %s", range_text(r->frames, range));
    page_age(r->job->clock.years_per_frame, age);
    text_add(t, ", %s a frame, %g frames a second", age, r->job->fps);
    if (*r->job->output.owner) {
        text_add(t, " &middot; ");
        html_text(t, r->job->output.owner);
    }
    text_add(t, "</p>\n");
    if (*r->job->output.comments) {
        text_add(t, "<p class=\"sub\">");
        html_text(t, r->job->output.comments);
        text_add(t, "</p>\n");
    }
    text_add(t, "</header>\n<main>\n");
    add_tiles(r, t);
    add_troubles(r, t);
    text_add(t, "<section><h2>Pictures</h2>\n");
    add_pictures(r, t);
    text_add(t, "</section>\n");
    if (first && first != last) {
        page_curves(r, t);
    } else {
        text_add(t, "<section><h2>Erosion</h2><p>Curves begin with the second frame.</p></section>\n");
        page_rock(r, t);
    }
    page_timing(r, t);
    page_provenance(r, t);
    page_files(r, t);
    page_end(t);
}
