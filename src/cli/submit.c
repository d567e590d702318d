/* hoodoo submit JOB --to local|slurm|openjd|tasks: runs the job's tasks on this machine, submits them to a scheduler, or prints
 * them. */
#include <stdio.h>

#include "base/atomic_file.h"
#include "base/clock.h"
#include "base/log.h"
#include "base/progress.h"
#include "base/signals.h"
#include "cli/answer.h"
#include "cli/cli.h"
#include "farm/describe.h"
#include "farm/local.h"
#include "farm/openjd.h"
#include "farm/slurm.h"
#include "run/advice.h"

#define TO_CHOICE (TO_LOCAL, "local")(TO_SLURM, "slurm")(TO_OPENJD, "openjd")(TO_TASKS, "tasks")
/* Wedges whose warnings are logged; those of further wedges are mostly the same. */
enum { WARNED = 3 };

enum target { CHOICE_CONSTANTS(TO_CHOICE) };

struct wanted {
    struct common common;
    int to, wedge, workers;
    bool dry_run;
    const char *gpus;
};

/* ---- progress of a local farm */

struct view {
    const struct farm *farm;
    struct progress progress;
    double began;
    size_t frames, frames_before; /* done now, and at the start */
};

static void show_news(void *user, enum local_news what, const struct farm_task *t, int worker, double seconds,
                      const char *why)
{
    char took[32];
    (void)user;
    duration_text(seconds, took);
    switch (what) {
    case LOCAL_STARTED:
        log_info("%s: started by worker %d", t->name, worker);
        break;
    case LOCAL_DONE:
        log_info("%s: done in %s", t->name, took);
        break;
    case LOCAL_AGAIN:
        log_warn("%s: %s; it will be retried", t->name, why);
        break;
    case LOCAL_FAILED:
        log_warn("%s: failed permanently: %s (see log/farm/%s.log)", t->name, why, t->name);
        break;
    case LOCAL_LEFT_OUT:
        log_warn("%s: skipped, because it depends on %s", t->name, why);
        break;
    case LOCAL_SAVED:
        log_info("%s: stopped after %s", t->name, took);
        break;
    }
}

static void show_state(void *user, const struct local_state *s)
{
    struct view *v = user;
    char line[300], left[32] = "";
    size_t total = 0;
    v->frames = farm_frames(v->farm, &total);
    int n = snprintf(line, sizeof line, "%zu/%zu tasks, %zu/%zu frames", s->done, s->total, v->frames, total);
    double spent = clock_seconds() - v->began;
    if (v->frames > v->frames_before && v->frames < total && n > 0) {
        double each = spent / (double)(v->frames - v->frames_before);
        n += snprintf(line + n, sizeof line - (size_t)n, ", %s of simulation to go",
                      duration_text(each * (double)(total - v->frames), left));
    }
    if (s->failed && n > 0)
        n += snprintf(line + n, sizeof line - (size_t)n, ", %zu FAILED", s->failed);
    for (size_t k = 0, first = 1; k < LOCAL_WORKERS && n > 0 && (size_t)n < sizeof line - 90; k++)
        if (s->task[k]) {
            n += snprintf(line + n, sizeof line - (size_t)n, "%s %s", first ? " |" : ",", s->task[k]->name);
            first = 0;
        }
    progress_note(&v->progress, s->done, s->total, line);
}

static status to_local(const struct wanted *w, struct farm *f)
{
    status st = OK;
    struct view v = {.farm = f, .began = clock_seconds()};
    struct local_worker worker[LOCAL_WORKERS];
    size_t n = 0, total;
    struct path path;
    TRY(local_workers(w->gpus, w->workers, worker, &n));
    if (w->common.device)
        for (size_t i = 0; i < n; i++)
            snprintf(worker[i].device, sizeof worker[i].device, "%s", w->common.device);
    TRY(farm_freeze(f));
    TRY(path_join(&path, f->root.text, "log/farm.log"));
    TRY(log_open(path.text));
    signals_install();
    v.frames_before = farm_frames(f, &total);
    log_info("%zu tasks for %zu workers; %zu of %zu frames are done", f->graph.n, n, v.frames_before, total);
    progress_begin_notes(&v.progress, (enum progress_style)w->common.progress);
    TRY(local_run(f, &(struct local_options){.worker = worker,
                                             .n_workers = n,
                                             .stop = stop_requested,
                                             .news = show_news,
                                             .tick = show_state,
                                             .user = &v}));
    progress_end(&v.progress);
    log_info("all %zu tasks are done: %s", f->graph.n, f->root.text);
done:
    progress_end(&v.progress);
    return st;
}

/* ---- Slurm */

static status to_slurm(const struct wanted *w, const struct arguments *operands, struct farm *f)
{
    status st = OK;
    struct text t = {0};
    struct path path;
    if (!w->dry_run) {
        TRY(farm_freeze(f));
        TRY(path_join(&path, f->root.text, "log/farm.log"));
        TRY(log_open(path.text));
    }
    json_object(&t, NULL);
    json_text(&t, "name", f->base->name);
    json_text(&t, "folder", f->root.text);
    TRY(slurm_submit(f,
                     &(struct slurm_options){.device = w->common.device,
                                             .extra = operands->item + 1, /* after the job */
                                             .n_extra = operands->n - 1,
                                             .dry_run = w->dry_run},
                     &t));
    json_end_object(&t);
    TRY(answer_print(&t, w->common.json));
done:
    text_free(&t);
    return st;
}

/* ---- OpenJD */

static status to_openjd(const struct wanted *w, struct farm *f)
{
    status st = OK;
    struct text t = {0};
    struct path path;
    if (!w->dry_run)
        TRY(farm_freeze(f));
    TRY(openjd_template(f, w->common.device, &t));
    if (w->dry_run) {
        fputs(t.data, stdout);
        goto done;
    }
    TRY(path_format(&path, "%s/%s.openjd.json", f->root.text, f->base->name));
    TRY(atomic_file_write(path.text, t.data, t.size));
    log_info("%s: submit it with your farm's client, or try it with 'openjd run %s --step ...'", path.text,
             path.text);
done:
    text_free(&t);
    return st;
}

/* ---- the verb */

static status print_tasks(const struct wanted *w, const struct farm *f, bool as_json)
{
    status st = OK;
    struct text t = {0};
    json_object(&t, NULL);
    if (as_json)
        json_integer(&t, "format", 1);
    json_text(&t, "name", f->base->name);
    json_text(&t, "folder", f->root.text);
    TRY(farm_describe(f, !as_json, w->common.device, &t));
    json_end_object(&t);
    TRY(answer_print(&t, as_json));
done:
    text_free(&t);
    return st;
}

/* ---- any other farm: the tasks as JSON */

static status to_tasks(const struct wanted *w, struct farm *f)
{
    status st = OK;
    if (!w->dry_run)
        TRY(farm_freeze(f));
    TRY(print_tasks(w, f, true));
done:
    return st;
}

static status dispatch(const struct wanted *w, const struct arguments *operands, struct farm *f)
{
    if (w->to != TO_SLURM && operands->n > 1)
        return fail(E_USAGE,
                    "submit: unexpected argument '%.80s'; only --to slurm passes arguments on, to sbatch",
                    operands->item[1]);
    switch ((enum target)w->to) {
    case TO_LOCAL:
        return w->dry_run ? print_tasks(w, f, w->common.json) : to_local(w, f);
    case TO_SLURM:
        return to_slurm(w, operands, f);
    case TO_OPENJD:
        return to_openjd(w, f);
    case TO_TASKS:
        return to_tasks(w, f);
    }
    return OK;
}

status cli_submit(int argc, char **argv)
{
    status st = OK;
    struct wanted w = {.to = -1};
    struct arguments operands = {0};
    struct farm farm = {0};
    struct path root;
    bool help = false;
    const struct option options[] = {
        {"to", CHOICE_TEXT(TO_CHOICE), OPTION_CHOICE, &w.to,
         "local: run on this machine's devices; slurm: submit with sbatch; openjd: write a job template (jobtemplate-2023-09); tasks: print the tasks as JSON for any other farm, each with its command, dependencies and resources"},
        OPTION_OUT(&w.common),
        {"dry-run", NULL, OPTION_FLAG, &w.dry_run, "print what would be submitted, without submitting it"},
        {"gpus", "LIST", OPTION_TEXT, &w.gpus, "local: one worker per listed device, such as 0,1"},
        {"workers", "N", OPTION_INT, &w.workers, "local: number of workers, which share the CPU"},
        OPTION_DEVICE(&w.common),
        OPTION_SET(&w.common),
        OPTION_FROM(&w.common),
        OPTION_WEDGE(&w.wedge),
        OPTION_PROGRESS(&w.common),
        OPTION_JSON(&w.common),
    };
    TRY(options_parse(&usage_submit, options, sizeof options / sizeof *options, argc, argv, &operands,
                      &help));
    if (help)
        goto done;
    if (w.to < 0) {
        st = fail(E_USAGE, "submit: --to is missing; give --to local, slurm, openjd or tasks");
        goto done;
    }
    TRY(farm_load(operands.item[0], w.common.sets.item, w.common.sets.n, w.common.from, w.wedge, w.common.out,
                  &farm));
    for (size_t i = 0; i < farm.n_wedges && i < WARNED; i++)
        TRY(advice_log(farm.wedge[i].job));
    for (size_t i = 0; i < farm.n_wedges; i++) {
        TRY(farm_root(&farm, (int)farm.wedge[i].job->wedge.index, &root));
        farm.wedge[i].frame_seconds = farm_frame_seconds(root.text, farm.wedge[i].job->name);
    }
    TRY(farm_graph(&farm));
    TRY(dispatch(&w, &operands, &farm));
done:
    farm_free(&farm);
    arguments_free(&operands);
    common_free(&w.common);
    return st;
}
