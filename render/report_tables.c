/* Timing, provenance and files. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "render/report_page.h"
#include "system/progress.h"

/* ---- timing */

enum { MOST_STAGES = 32, MOST_SESSIONS = 40 };

static const char *text_of(const struct json *object, const char *key)
{
    const char *value = json_to_text(json_member(object, key));
    return value ? value : "";
}

static int longest_first(const void *a, const void *b)
{
    const double x = ((const struct row *)a)->value, y = ((const struct row *)b)->value;
    return (x < y) - (x > y);
}

static size_t add_up(const struct report *r, struct row row[MOST_STAGES])
{
    size_t n = 0;
    for (size_t i = 0; i < r->n_timing; i++) {
        const struct json *stages = json_member(r->timing[i], "stages");
        for (const struct json *s = stages && stages->kind == JSON_ARRAY ? stages->first : NULL; s;
             s = s->next) {
            const char *name = json_to_text(json_member(s, "name"));
            size_t k = 0;
            if (!name || !*name)
                continue;
            while (k < n && strncmp(row[k].name, name, sizeof row[k].name - 1) != 0)
                k++;
            if (k == MOST_STAGES)
                continue;
            if (k == n) {
                row[n] = (struct row){.color = "#2f5f8a"};
                snprintf(row[n++].name, sizeof row->name, "%s", name);
            }
            row[k].value += page_number(s, "device_seconds");
        }
    }
    return n;
}

static void add_sessions(const struct report *r, struct text *t)
{
    char took[32];
    json_array(t, "sessions");
    for (size_t i = r->n_timing > MOST_SESSIONS ? r->n_timing - MOST_SESSIONS : 0; i < r->n_timing; i++) {
        const struct json *s = r->timing[i];
        PAGE_ROW(t, NULL, "ended", text_of(s, "ended"), "from",
                 phrase("%.0f", page_number(s, "first_frame")).text, "to",
                 phrase("%.0f", page_number(s, "last_frame")).text, "took",
                 duration_text(page_number(s, "wall_seconds"), took), "device", text_of(s, "device"));
    }
    json_end_array(t);
}

void page_timing(const struct report *r, struct text *t)
{
    struct row row[MOST_STAGES];
    const size_t n = add_up(r, row);
    struct text svg = {0};
    double most = 0, sum = 0;
    char number[48];
    if (n == 0)
        return;
    for (size_t i = 0; i < n; i++) {
        sum += row[i].value;
        most = fmax(most, row[i].value);
    }
    for (size_t i = 0; i < n; i++)
        snprintf(row[i].note, sizeof row[i].note, "%.40s s, %.0f %%", html_number(row[i].value, number),
                 sum > 0 ? 100 * row[i].value / sum : 0);
    qsort(row, n, sizeof *row, longest_first);
    chart_rows("Time on the device by stage", "seconds, all sessions together", row, n, most, &svg);
    json_object(t, "timing");
    page_chart(t, "stages_chart", &svg);
    add_sessions(r, t);
    json_end_object(t);
}

/* ---- provenance */

static void add_inputs(const struct json *inputs, struct text *t)
{
    if (!inputs || inputs->kind != JSON_ARRAY || inputs->n == 0)
        return;
    json_object(t, "inputs");
    json_array(t, "input");
    for (const struct json *i = inputs->first; i; i = i->next)
        PAGE_ROW(t, NULL, "path", text_of(i, "path"), "size", phrase("%.0f", page_number(i, "size")).text,
                 "hash", text_of(i, "xxh3"));
    json_end_array(t);
    json_end_object(t);
}

/* Builds and devices that made earlier frames, if the run was continued by others. */
static void add_makers(const struct json *continued, struct text *t)
{
    if (!continued || continued->kind != JSON_ARRAY)
        return;
    for (const struct json *v = continued->first; v; v = v->next)
        PAGE_ROW(t, NULL, "fact", phrase("up to frame %.0f", page_number(v, "frame")).text, "value",
                 phrase("hoodoo %s (%s, build %s) on %s", text_of(v, "version"), text_of(v, "commit"),
                        text_of(v, "build"), text_of(v, "device"))
                     .text);
}

void page_provenance(const struct report *r, struct text *t)
{
    static const char *const known[][2] = {{"version", "hoodoo"},
                                           {"commit", "commit"},
                                           {"build", "build"},
                                           {"device", "device"},
                                           {"driver", "driver"},
                                           {"device_uuid", "device UUID"},
                                           {"device_pci", "PCI address"},
                                           {"job_hash", "hash of the job"},
                                           {"from", "branched from"}};
    json_object(t, "provenance");
    json_array(t, "facts");
    for (size_t i = 0; i < sizeof known / sizeof *known; i++)
        if (*text_of(r->run, known[i][0]))
            PAGE_ROW(t, NULL, "fact", known[i][1], "value", text_of(r->run, known[i][0]));
    add_makers(json_member(r->run, "continued"), t);
    PAGE_ROW(t, NULL, "fact", "seed", "value", phrase("%lld", (long long)r->job->seed).text);
    json_end_array(t);
    add_inputs(json_member(r->run, "inputs"), t);
    if (r->log) {
        json_object(t, "log");
        page_lines(t, "lines", r->log);
        json_end_object(t);
    }
    json_end_object(t);
}

/* ---- files */

static void add_checkpoints(const struct report *r, struct text *t)
{
    struct path path, full;
    struct stat info;
    const char *comma = "";
    json_array(t, "checkpoints");
    for (size_t i = 0; i < r->n_checkpoints; i++) {
        if (folder_name(&path, r->name, FILE_CHECKPOINT, r->checkpoint[i], NULL) != OK)
            continue; /* a path that is too long cannot have been found */
        const bool there = path_join(&full, r->root, path.text) == OK && stat(full.text, &info) == 0;
        PAGE_ROW(t, NULL, "comma", comma, "path", path.text, "frame", phrase("%d", r->checkpoint[i]).text,
                 "size", phrase_bytes(there ? (uint64_t)info.st_size : 0).text);
        comma = ", ";
    }
    json_end_array(t);
}

/* Adds the file if it exists. `path` is relative to root. */
static void add_file(const struct report *r, const char *path, const char *what, struct text *t)
{
    struct path full;
    struct stat info;
    if (path_join(&full, r->root, path) == OK && stat(full.text, &info) == 0)
        PAGE_ROW(t, NULL, "path", path, "what", what, "size",
                 S_ISREG(info.st_mode) ? phrase_bytes((uint64_t)info.st_size).text : "");
}

static void add_named(const struct report *r, enum folder_file kind, const char *what, struct text *t)
{
    struct path path;
    if (folder_name(&path, r->name, kind, 0, NULL) == OK)
        add_file(r, path.text, what, t);
}

static void add_frame(const struct report_frame *f, struct text *t)
{
    const struct manifest *m = &f->manifest;
    json_object(t, NULL);
    json_integer(t, "frame", m->frame);
    json_bool(t, "bad", f->damaged);
    json_array(t, "its_files");
    for (size_t i = 0; i < m->n_files; i++) {
        const char *path = m->file[i].path, *dot = strrchr(path, '.');
        PAGE_ROW(t, NULL, "comma", i ? ", " : "", "path", path, "words",
                 phrase("%.*s%s", (int)strcspn(path, "/"), path, dot ? dot : "").text, "size",
                 phrase_bytes(m->file[i].size).text);
    }
    json_end_array(t);
    if (!f->damaged)
        PAGE_ROW(t, "good", "age", phrase_age(m->years).text, "volume", phrase_number(m->volume_m3).text,
                 "stress", phrase("%.2f", m->max_stress_Pa / 1e6).text, "iterations",
                 phrase("%d", m->stress_iterations).text);
    json_end_object(t);
}

void page_files(const struct report *r, struct text *t)
{
    json_array(t, "files");
    add_named(r, FILE_STAGE, "the sequence as a USD stage: volumes, points, cameras", t);
    add_named(r, FILE_VIDEO, "the turntable", t);
    add_named(r, FILE_SHEET, "the contact sheet", t);
    add_file(r, "points/", "OpenVDB points, and USD points of the surface, a file a frame", t);
    add_file(r, "volumes/", "OpenVDB grids, a file a frame", t);
    add_file(r, "aov/", "EXR pictures of the fields, a file a frame", t);
    add_file(r, "mesh/", "the surface as triangles, PLY and OBJ", t);
    add_file(r, "frames/", "what says that a frame is done: sizes, hashes, numbers", t);
    json_end_array(t);
    add_checkpoints(r, t);
    if (r->n_frames) {
        json_object(t, "every_frame");
        json_bool(t, "few", r->n_frames <= 24);
        json_array(t, "rows");
        for (size_t i = 0; i < r->n_frames; i++)
            add_frame(&r->frame[i], t);
        json_end_array(t);
        json_end_object(t);
    }
}
