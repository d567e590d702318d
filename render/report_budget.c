/* The volume that each process removed per frame, from change_m3 of the manifests. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "job/job.h"
#include "render/report_page.h"

/* In stacking order, from below. */
#define PROCESS(constant, word, models, stacked, color, legend, meaning) [stacked] = PROCESS_##constant,
static const enum process order[] = {JOB_PROCESSES(PROCESS)};
#undef PROCESS
_Static_assert(sizeof order / sizeof *order == PROCESSES, "each process has a curve of its own");

struct budget_curves {
    size_t n; /* sound frames whose manifest has a budget */
    double *time, *rate[PROCESSES], taken[PROCESSES], added[PROCESSES];
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
        for (size_t p = 0; p < PROCESSES; p++) {
            const struct manifest_change *change = change_of(m, job_processes[order[p]].name);
            const double m3 = change && isfinite(change->m3) ? change->m3 : 0;
            c->rate[p][c->n] = m3 < 0 && lasted > 0 ? -m3 / (lasted * clock->per) : 0;
            c->taken[p] += fmax(-m3, 0);
            c->added[p] += fmax(m3, 0);
        }
        c->n++;
    }
}

/* Empty where nothing was removed or added. */
static struct phrase phrase_volume(double m3)
{
    return m3 > 0 ? phrase_number(m3) : phrase("%s", "");
}

static void add_rows(const struct budget_curves *c, struct text *t)
{
    double taken = 0, added = 0;
    for (size_t p = 0; p < PROCESSES; p++) {
        taken += c->taken[p];
        added += c->added[p];
    }
    json_array(t, "processes");
    for (size_t p = 0; p < PROCESSES; p++)
        if (c->taken[p] > 0 || c->added[p] > 0)
            PAGE_ROW(t, NULL, "process", job_processes[order[p]].legend, "taken",
                     phrase_volume(c->taken[p]).text, "added", phrase_volume(c->added[p]).text, "share",
                     phrase("%.1f", taken > 0 ? 100 * c->taken[p] / taken : 0).text);
    json_end_array(t);
    PAGE_MEMBERS(t, "all_taken", phrase_number(taken).text, "all_added", phrase_volume(added).text);
}

void page_budget(const struct report *r, const struct page_clock *clock, struct text *t)
{
    struct budget_curves c = {0};
    struct series series[PROCESSES];
    size_t n_series = 0;
    char label[32];
    struct text svg = {0};
    status st = memory_alloc(r->n_frames, sizeof(double), "curves", &c.time);
    for (size_t p = 0; p < PROCESSES && st == OK; p++)
        st = memory_alloc(r->n_frames, sizeof(double), "curves", &c.rate[p]);
    if (st != OK) {
        t->failed = true;
        goto done;
    }
    fill(r, clock, &c);
    for (size_t p = 0; p < PROCESSES; p++)
        if (c.taken[p] > 0)
            series[n_series++] =
                (struct series){job_processes[order[p]].legend, job_processes[order[p]].color, c.rate[p]};
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
                                .stacked = true,
                                .mark = &clock->now},
                &svg);
    json_object(t, "budget");
    page_chart(t, "budget_chart", &svg);
    add_rows(&c, t);
    json_end_object(t);
done:
    free(c.time);
    for (size_t p = 0; p < PROCESSES; p++)
        free(c.rate[p]);
}
