#include "render/report_wedges.h"

#include <inttypes.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/memory.h"
#include "job/job.h"
#include "output/folder.h"
#include "render/report_page.h"
#include "system/atomic_file.h"

enum { SERIES_MAX = 8, STILL_BYTES = 64 << 20 };

struct wedge {
    struct job *job;
    size_t n_frames, n_damaged; /* completed frames, and frames whose manifests cannot be read */
    struct manifest last;
    double *share; /* % of the rock left in each of the job's frames; constant after the last completed one */
};

struct sweep {
    const char *root;
    struct job *base;
    size_t n, n_x;
    struct wedge *wedge;
    double *x; /* frames */
};

static void free_sweep(struct sweep *s)
{
    for (size_t i = 0; s->wedge && i < s->n; i++) {
        job_destroy(&s->wedge[i].job);
        manifest_free(&s->wedge[i].last);
        free(s->wedge[i].share);
    }
    free(s->wedge);
    free(s->x);
    job_destroy(&s->base);
}

static status gather_wedge(struct sweep *s, struct wedge *w)
{
    status st = OK;
    struct path root;
    int *frames = NULL;
    size_t n, k = 0;
    double share = 100;
    TRY(path_wedge(&root, s->root, (int)w->job->wedge.index));
    TRY(memory_alloc(s->n_x, sizeof *w->share, "curves", &w->share));
    TRY(folder_frames(root.text, w->job->name, &frames, &n));
    for (size_t i = 0; i < n; i++) {
        struct manifest m = {0};
        st = manifest_read(root.text, w->job->name, frames[i], &m);
        if (st == E_INPUT) {
            w->n_damaged++;
            st = OK;
            continue;
        }
        TRY(st);
        for (; k < s->n_x && s->x[k] < frames[i]; k++)
            w->share[k] = share;
        share = m.start_volume_m3 > 0 ? 100 * m.volume_m3 / m.start_volume_m3 : 0;
        manifest_free(&w->last);
        w->last = m;
        w->n_frames++;
    }
    for (; k < s->n_x; k++)
        w->share[k] = share;
done:
    free(frames);
    return st;
}

static status gather(struct sweep *s)
{
    status st = OK;
    struct path path;
    TRY(path_join(&path, s->root, "farm/job.yaml"));
    TRY(job_load(path.text, NULL, 0, &s->base));
    size_t n = job_wedges(s->base);
    if (n == 0) {
        st = fail(E_INPUT, "%s contains neither a run nor wedges", s->root);
        goto done;
    }
    TRY(memory_alloc(n, sizeof *s->wedge, "the wedges", &s->wedge));
    for (; s->n < n; s->n++)
        TRY(job_load_wedge(path.text, NULL, 0, s->base, (int)s->n + 1, &s->wedge[s->n].job));
    s->n_x = range_count(s->wedge[0].job->frames);
    TRY(memory_alloc(s->n_x, sizeof *s->x, "curves", &s->x));
    for (size_t i = 0; i < s->n_x; i++)
        s->x[i] = s->wedge[0].job->frames.first + (double)i * s->wedge[0].job->frames.step;
    for (size_t i = 0; i < s->n; i++)
        TRY(gather_wedge(s, &s->wedge[i]));
done:
    return st;
}

/* Copies the still of the wedge's last frame to report/w0001.png and so on; *there: the wedge has one. */
static status copy_still(const struct sweep *s, const struct wedge *w, bool *there)
{
    status st = OK;
    struct path root, path;
    char number[FRAME_TEXT];
    void *bytes = NULL;
    size_t size;
    TRY(path_wedge(&root, s->root, (int)w->job->wedge.index));
    TRY(folder_path(&path, root.text, w->job->name, FILE_STILL, w->last.frame, NULL));
    *there = w->n_frames > 0 && access(path.text, R_OK) == 0;
    if (!*there)
        return OK;
    TRY(file_read(path.text, STILL_BYTES, (char **)&bytes, &size));
    TRY(path_format(&path, "report/%s.png", wedge_text((int)w->job->wedge.index, number)));
    const struct recipe recipe = report_recipe(s->root);
    TRY(product_write(&recipe, path.text, bytes, size));
done:
    free(bytes);
    return st;
}

static void add_wedge(const struct sweep *s, const struct wedge *w, struct text *t)
{
    const struct ledger *l = &w->last.ledger;
    struct path path, whole;
    char number[FRAME_TEXT];
    const bool report =
        path_join(&path, wedge_text((int)w->job->wedge.index, number), "report/index.html") == OK &&
        path_join(&whole, s->root, path.text) == OK && access(whole.text, R_OK) == 0;
    json_object(t, NULL);
    PAGE_MEMBERS(t, "wedge", number, "values", w->job->wedge.label, "n_done", phrase("%zu", w->n_frames).text,
                 "n_frames", phrase("%zu", range_count(w->job->frames)).text, "n_damaged",
                 w->n_damaged ? phrase("%zu", w->n_damaged).text : "", "report", report ? path.text : "");
    if (w->n_frames)
        PAGE_ROW(t, "begun", "left", phrase("%.1f", w->share[s->n_x - 1]).text, "deposit",
                 phrase("%" PRIu64, l->deposit).text, "fallen", phrase("%" PRIu64, l->fallen).text, "away",
                 phrase("%" PRIu64, l->left).text);
    json_end_object(t);
}

static void add_chart(const struct sweep *s, struct text *t)
{
    static const char *const colors[SERIES_MAX] = {"#a9491f", "#2f5f8a", "#e8bd52", "#4d7a3a",
                                                   "#7b4b94", "#111111", "#d0743c", "#7d8a91"};
    char names[SERIES_MAX][FRAME_TEXT];
    struct series series[SERIES_MAX];
    size_t n = 0;
    for (size_t i = 0; i < s->n && n < SERIES_MAX; i++) {
        if (!s->wedge[i].n_frames)
            continue;
        series[n] = (struct series){wedge_text((int)s->wedge[i].job->wedge.index, names[n]), colors[n],
                                    s->wedge[i].share};
        n++;
    }
    if (n == 0 || s->n_x < 2)
        return;
    struct text svg = {0};
    chart_lines(&(struct chart){.title = "What is left of the rock, by frame",
                                .x_label = "frame",
                                .y_label = "rock left, %",
                                .n = s->n_x,
                                .x = s->x,
                                .n_series = n,
                                .series = series,
                                .from_zero = true},
                &svg);
    page_chart(t, "shares_chart", &svg);
    if (s->n > SERIES_MAX)
        json_integer(t, "most_shares", SERIES_MAX);
}

static status add_stills(const struct sweep *s, struct text *t)
{
    status st = OK;
    json_array(t, "stills");
    for (size_t i = 0; i < s->n; i++) {
        const struct wedge *w = &s->wedge[i];
        char number[FRAME_TEXT];
        bool there;
        TRY(copy_still(s, w, &there));
        if (!there)
            continue;
        PAGE_ROW(t, NULL, "still", wedge_text((int)w->job->wedge.index, number), "index",
                 phrase("%d", (int)w->job->wedge.index).text, "frame", phrase("%d", w->last.frame).text,
                 "values", w->job->wedge.label);
    }
    json_end_array(t);
done:
    return st;
}

status report_wedges(const char *root, struct text *page, bool *sound)
{
    status st = OK;
    struct sweep s = {.root = root};
    struct path path;
    struct text t = {0};
    char range[48];
    TRY(gather(&s));
    TRY(path_join(&path, root, "report"));
    TRY(folder_make(path.text));
    *sound = false;
    for (size_t i = 0; i < s.n; i++)
        *sound |= s.wedge[i].n_frames > 0;
    json_object(&t, NULL);
    json_object(&t, "sweep");
    json_integer(&t, "n_wedges", (int64_t)s.n);
    json_text(&t, "frames", range_text(s.wedge[0].job->frames, range));
    json_bool(&t, "nothing_sound", !*sound);
    json_array(&t, "wedges");
    for (size_t i = 0; i < s.n; i++)
        add_wedge(&s, &s.wedge[i], &t);
    json_end_array(&t);
    add_chart(&s, &t);
    TRY(add_stills(&s, &t));
    json_end_object(&t);
    TRY(page_fill(s.base->name, &t, page));
done:
    text_free(&t);
    free_sweep(&s);
    return st;
}
