/* Timing, provenance and files. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "base/progress.h"
#include "render/report_page.h"

/* ---- timing */

enum { MOST_STAGES = 32, MOST_SESSIONS = 40 };

static double number_of(const struct json *object, const char *key)
{
    const struct json *number = json_member(object, key);
    return number && number->kind == JSON_NUMBER && isfinite(number->number) ? number->number : 0;
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
            row[k].value += number_of(s, "device_seconds");
        }
    }
    return n;
}

static void add_sessions(const struct report *r, struct text *t)
{
    char duration[32];
    const size_t from = r->n_timing > MOST_SESSIONS ? r->n_timing - MOST_SESSIONS : 0;
    text_add(t, "<div class=\"scroll\"><table><thead><tr><th>Ended, UTC</th><th>Frames</th><th "
                "class=\"n\">Time</th><th>Device"
                "</th></tr></thead><tbody>\n");
    for (size_t i = from; i < r->n_timing; i++) {
        const struct json *s = r->timing[i];
        const char *ended = json_to_text(json_member(s, "ended")),
                   *device = json_to_text(json_member(s, "device"));
        text_add(t, "<tr><td class=\"d\">");
        html_text(t, ended ? ended : "");
        text_add(t, "</td><td class=\"d\">%.0f\xe2\x80\x93%.0f</td><td class=\"n\">%s</td><td>",
                 number_of(s, "first_frame"), number_of(s, "last_frame"),
                 duration_text(number_of(s, "wall_seconds"), duration));
        html_text(t, device ? device : "");
        text_add(t, "</td></tr>\n");
    }
    text_add(t, "</tbody></table></div>\n");
}

void page_timing(const struct report *r, struct text *t)
{
    struct row row[MOST_STAGES];
    const size_t n = add_up(r, row);
    double most = 0, sum = 0;
    char number[48];
    text_add(t, "<section><h2>Timing</h2>\n");
    if (n == 0) {
        text_add(t, "<p>There is none: <code>hoodoo run</code> writes <code>log/timing.jsonl</code> when it "
                    "ends, unless it is "
                    "killed.</p></section>\n");
        return;
    }
    for (size_t i = 0; i < n; i++) {
        sum += row[i].value;
        most = fmax(most, row[i].value);
    }
    for (size_t i = 0; i < n; i++)
        snprintf(row[i].note, sizeof row[i].note, "%.40s s, %.0f %%", html_number(row[i].value, number),
                 sum > 0 ? 100 * row[i].value / sum : 0);
    qsort(row, n, sizeof *row, longest_first);
    text_add(t, "<div class=\"two\">\n");
    chart_rows("Time on the device by stage", "seconds, all sessions together", row, n, most, t);
    add_sessions(r, t);
    text_add(t, "</div></section>\n");
}

/* ---- provenance */

static void add_row(struct text *t, const char *name, const char *value)
{
    text_add(t, "<tr><th scope=\"row\">%s</th><td>", name);
    html_text(t, value);
    text_add(t, "</td></tr>\n");
}

static void add_inputs(const struct json *inputs, struct text *t)
{
    if (!inputs || inputs->kind != JSON_ARRAY || inputs->n == 0) {
        text_add(t, "<p>The job reads no other files.</p>\n");
        return;
    }
    text_add(t, "<div class=\"scroll\"><table><thead><tr><th>Input file</th><th "
                "class=\"n\">Bytes</th><th>XXH3-64</th></tr></thead><tbody>\n");
    for (const struct json *i = inputs->first; i; i = i->next) {
        const char *path = json_to_text(json_member(i, "path")), *hash = json_to_text(json_member(i, "xxh3"));
        text_add(t, "<tr><td><code>");
        html_text(t, path ? path : "");
        text_add(t, "</code></td><td class=\"n\">%.0f</td><td><code>", number_of(i, "size"));
        html_text(t, hash ? hash : "");
        text_add(t, "</code></td></tr>\n");
    }
    text_add(t, "</tbody></table></div>\n");
}

void page_provenance(const struct report *r, struct text *t)
{
    static const struct {
        const char *key, *name;
    } known[] = {{"version", "hoodoo"},         {"commit", "commit"},
                 {"kernels", "kernels' hash"},  {"device", "device"},
                 {"driver", "driver"},          {"device_uuid", "device UUID"},
                 {"device_pci", "PCI address"}, {"job_hash", "hash of the job"},
                 {"from", "branched from"}};
    char number[32];
    text_add(t, "<section><h2>Provenance</h2>\n<div class=\"scroll\"><table><tbody>\n");
    for (size_t i = 0; i < sizeof known / sizeof *known; i++) {
        const char *value = json_to_text(json_member(r->run, known[i].key));
        if (value && *value)
            add_row(t, known[i].name, value);
    }
    snprintf(number, sizeof number, "%lld", (long long)r->job->seed);
    add_row(t, "seed", number);
    text_add(t, "</tbody></table></div>\n<p>");
    page_link(t, "job.yaml", "job.yaml");
    text_add(t, " is the job as it was run, every default filled in; ");
    page_link(t, "run.json", "run.json");
    text_add(t, " is this table for programs. The same job on the same binary, driver and device gives the "
                "same bytes.</p>\n");
    add_inputs(json_member(r->run, "inputs"), t);
    if (r->log) {
        text_add(t, "<details><summary>The end of the log</summary>\n<pre>");
        for (const char *line = r->log; *line;) { /* html_text() makes line ends spaces */
            const size_t n = strcspn(line, "\n");
            char part[2400];
            snprintf(part, sizeof part, "%.*s", (int)(n < 2300 ? n : 2300), line);
            html_text(t, part);
            text_add(t, "\n");
            line += n + (line[n] == '\n');
        }
        text_add(t, "</pre>");
        page_link(t, "log/run.log", "log/run.log");
        text_add(t, "</details>\n");
    }
    text_add(t, "</section>\n");
}

/* ---- files */

static void add_checkpoints(const struct report *r, struct text *t)
{
    struct path path, full;
    char number[16], size[48];
    struct stat info;
    text_add(t, "<p>Checkpoints a run goes on from: ");
    for (size_t i = 0; i < r->n_checkpoints; i++) {
        const int frame = r->checkpoint[i];
        if (folder_name(&path, r->name, FILE_CHECKPOINT, frame, NULL) != OK)
            continue; /* it would not have been found */
        const bool there = path_join(&full, r->root, path.text) == OK && stat(full.text, &info) == 0;
        page_bytes(there ? (uint64_t)info.st_size : 0, size);
        text_add(t, i ? ", frame " : "frame ");
        snprintf(number, sizeof number, "%d", frame);
        page_link(t, path.text, number);
        text_add(t, " (%s)", size);
    }
    text_add(t, r->n_checkpoints ? ".</p>\n" : "none.</p>\n");
}

/* If it is there. `path` is relative to root. */
static void add_file(const struct report *r, const char *path, const char *what, struct text *t)
{
    struct path full;
    char size[48];
    struct stat info;
    if (path_join(&full, r->root, path) != OK || stat(full.text, &info) != 0)
        return;
    page_bytes((uint64_t)info.st_size, size);
    text_add(t, "<tr><td>");
    page_link(t, path, path);
    text_add(t, "</td><td>%s</td><td class=\"n\">%s</td></tr>\n", what, S_ISREG(info.st_mode) ? size : "");
}

static void add_named(const struct report *r, enum folder_file kind, const char *what, struct text *t)
{
    struct path path;
    if (folder_name(&path, r->name, kind, 0, NULL) == OK)
        add_file(r, path.text, what, t);
}

static void add_frames(const struct report *r, struct text *t)
{
    char age[48], number[48], stress[48];
    text_add(t,
             "<details%s><summary>Every frame</summary>\n<div class=\"scroll\"><table><thead><tr><th "
             "class=\"n\">Frame</th><th "
             "class=\"n\">Time</th><th class=\"n\">Rock, m³</th><th class=\"n\">Greatest stress, MPa</th><th "
             "class=\"n\">Stress "
             "iterations</th><th>Files</th></tr></thead><tbody>\n",
             r->n_frames <= 24 ? " open" : "");
    for (size_t i = 0; i < r->n_frames; i++) {
        const struct manifest *m = &r->frame[i].manifest;
        if (r->frame[i].damaged) {
            text_add(t, "<tr><td class=\"n\">%d</td><td colspan=\"5\">damaged</td></tr>\n", m->frame);
            continue;
        }
        page_age(m->years, age);
        snprintf(stress, sizeof stress, "%.2f", m->max_stress_Pa / 1e6);
        text_add(t,
                 "<tr><td class=\"n\">%d</td><td class=\"n\">%s</td><td class=\"n\">%s</td><td "
                 "class=\"n\">%s</td><td class=\"n\">%d</td><td>",
                 m->frame, age, html_number(m->volume_m3, number), stress, m->stress_iterations);
        for (size_t f = 0; f < m->n_files; f++) {
            char size[48], words[160];
            const char *path = m->file[f].path, *dot = strrchr(path, '.');
            page_bytes(m->file[f].size, size);
            snprintf(words, sizeof words, "%.*s%.20s",
                     (int)(strcspn(path, "/") < 60 ? strcspn(path, "/") : 60), path, dot ? dot : "");
            text_add(t, f ? ", " : "");
            page_link(t, path, words);
            text_add(t, " %s", size);
        }
        text_add(t, "</td></tr>\n");
    }
    text_add(t, "</tbody></table></div></details>\n");
}

void page_files(const struct report *r, struct text *t)
{
    text_add(t, "<section><h2>Files</h2>\n<div class=\"scroll\"><table><tbody>\n");
    add_named(r, FILE_STAGE, "the sequence as a USD stage: volumes, points, cameras", t);
    add_named(r, FILE_VIDEO, "the turntable", t);
    add_named(r, FILE_SHEET, "the contact sheet", t);
    add_file(r, "points/", "OpenVDB points, and USD points of the surface, a file a frame", t);
    add_file(r, "volumes/", "OpenVDB grids, a file a frame", t);
    add_file(r, "aov/", "EXR pictures of the fields, a file a frame", t);
    add_file(r, "mesh/", "the surface as triangles, PLY and OBJ", t);
    add_file(r, "frames/", "what says that a frame is done: sizes, hashes, numbers", t);
    text_add(t, "</tbody></table></div>\n");
    add_checkpoints(r, t);
    if (r->n_frames)
        add_frames(r, t);
    text_add(t, "</section>\n");
}
