/* What each process took of the rock, frame by frame, as the manifests have it. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "job/job.h"
#include "render/report_page.h"

/* In the order they are stacked; lightness alternates. */
static const struct {
    const char *process, *name, *color;
} table[] = {
    {"deflation", "wind plucks grains", "#e0a458"},
    {"abrasion", "blown sand", "#8c4a2f"},
    {"weathering", "weathering", "#a9491f"},
    {"water", "running water", "#5b9bc4"},
    {"blocks", "blocks that nothing holds", "#3b3f46"},
    {"collapse", "out of the domain as it falls", "#7d8791"},
    {"edits", "edits", "#b9a3c9"},
    {"deposition", "deposits", "#e8d9a0"},
};
enum { TABLE = sizeof table / sizeof *table };

struct budget_curves {
    size_t n; /* sound frames that have one */
    double *time, *rate[TABLE], taken[TABLE], added[TABLE];
};

static const struct manifest_change *change_of(const struct manifest *m, const char *process)
{
    for (size_t i = 0; i < m->n_changes; i++)
        if (strcmp(m->change[i].process, process) == 0)
            return &m->change[i];
    return NULL;
}

static void fill(const struct report *r, const struct page_clock *clock, struct budget_curves *c)
{
    for (size_t i = 0; i < r->n_frames; i++) {
        const struct manifest *m = &r->frame[i].manifest;
        if (r->frame[i].damaged || !m->n_changes || m->frame == r->job->frames.first)
            continue;
        const double lasted = page_time(r, clock, m->frame) - page_time(r, clock, m->frame - 1);
        c->time[c->n] = page_time(r, clock, m->frame);
        for (size_t p = 0; p < TABLE; p++) {
            const struct manifest_change *change = change_of(m, table[p].process);
            const double m3 = change && isfinite(change->m3) ? change->m3 : 0;
            c->rate[p][c->n] = m3 < 0 && lasted > 0 ? -m3 / (lasted * clock->per) : 0;
            c->taken[p] += fmax(-m3, 0);
            c->added[p] += fmax(m3, 0);
        }
        c->n++;
    }
}

static void add_rows(const struct budget_curves *c, struct text *t)
{
    double taken = 0, added = 0;
    char number[2][48];
    for (size_t p = 0; p < TABLE; p++) {
        taken += c->taken[p];
        added += c->added[p];
    }
    text_add(
        t, "<div><h3>What took how much</h3><p>Over the frames there are.</p><table><thead><tr><th></th><th "
           "class=\"n\">taken, m³</th><th class=\"n\">added, m³</th><th class=\"n\">of all "
           "taken</th></tr></thead><tbody>\n");
    for (size_t p = 0; p < TABLE; p++)
        if (c->taken[p] > 0 || c->added[p] > 0)
            text_add(t,
                     "<tr><td>%s</td><td class=\"n\">%s</td><td class=\"n\">%s</td><td class=\"n\">%.1f "
                     "%%</td></tr>\n",
                     table[p].name, c->taken[p] > 0 ? html_number(c->taken[p], number[0]) : "",
                     c->added[p] > 0 ? html_number(c->added[p], number[1]) : "",
                     taken > 0 ? 100 * c->taken[p] / taken : 0);
    text_add(t, "<tr><th>together</th><td class=\"n\">%s</td><td class=\"n\">%s</td><td></td></tr>\n",
             html_number(taken, number[0]), added > 0 ? html_number(added, number[1]) : "");
    text_add(t, "</tbody></table></div>\n");
}

void page_budget(const struct report *r, const struct page_clock *clock, struct text *t)
{
    struct budget_curves c = {0};
    struct series series[TABLE];
    size_t n_series = 0;
    char label[32];
    status st = memory_alloc(r->n_frames, sizeof(double), "curves", &c.time);
    for (size_t p = 0; p < TABLE && st == OK; p++)
        st = memory_alloc(r->n_frames, sizeof(double), "curves", &c.rate[p]);
    if (st != OK) {
        t->failed = true;
        goto done;
    }
    fill(r, clock, &c);
    for (size_t p = 0; p < TABLE; p++)
        if (c.taken[p] > 0)
            series[n_series++] = (struct series){table[p].name, table[p].color, c.rate[p]};
    if (c.n < 2 || n_series == 0)
        goto done;
    snprintf(label, sizeof label, "m³ per %s", clock->rate);
    chart_lines(&(struct chart){.title = "What took it",
                                .x_label = clock->label,
                                .y_label = label,
                                .n = c.n,
                                .x = c.time,
                                .n_series = n_series,
                                .series = series,
                                .stacked = true},
                t);
    add_rows(&c, t);
done:
    free(c.time);
    for (size_t p = 0; p < TABLE; p++)
        free(c.rate[p]);
}
