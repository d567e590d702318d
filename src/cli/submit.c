/* hoodoo submit JOB --to local|slurm|openjd|deadline|opencue|tasks: the job's tasks, to this machine's devices, to a scheduler, or as data. */
#include <stdio.h>

#include "base/clock.h"
#include "base/log.h"
#include "cli/answer.h"
#include "cli/cli.h"
#include "cli/plan_time.h"
#include "cli/submit.h"
#include "farm/deadline.h"
#include "farm/describe.h"
#include "farm/local.h"
#include "farm/opencue.h"
#include "farm/openjd.h"
#include "farm/slurm.h"
#include "run/advice.h"
#include "system/atomic_file.h"
#include "system/progress.h"
#include "system/signals.h"

/* How many wedges are checked for settings that may surprise: they are alike. */
enum { WARNED = 3 };

/* ---- local */

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

static status to_local(const struct submit_request *r, struct farm *f)
{
    status st = OK;
    const struct submission *s = &r->submission;
    struct view v = {.farm = f, .began = clock_seconds()};
    struct local_worker worker[LOCAL_WORKERS];
    size_t n = 0, total;
    struct path path;
    TRY(local_workers(s->gpus, s->workers, worker, &n));
    if (s->device)
        for (size_t i = 0; i < n; i++)
            snprintf(worker[i].device, sizeof worker[i].device, "%s", s->device);
    TRY(farm_check_alone(f->root.text));
    TRY(farm_freeze(f));
    struct submission own = *s;
    process_self(&own.process);
    TRY(submission_write(f->root.text, &own));
    TRY(path_join(&path, f->root.text, "log/farm.log"));
    TRY(log_open(path.text));
    signals_install();
    v.frames_before = farm_frames(f, &total);
    log_info("%zu tasks for %zu workers; %zu of %zu frames are done", f->graph.n, n, v.frames_before, total);
    progress_begin_notes(&v.progress, (enum progress_style)r->progress);
    TRY(local_run(f, &(struct local_options){.worker = worker,
                                             .n_workers = n,
                                             .stop = stop_requested,
                                             .news = show_news,
                                             .tick = show_state,
                                             .user = &v}));
    progress_end(&v.progress);
    log_info("all %s are done: %s", f->chosen ? "chosen tasks" : "tasks", f->root.text);
done:
    progress_end(&v.progress);
    return st;
}

/* ---- Slurm */

static status to_slurm(const struct submit_request *r, struct farm *f)
{
    status st = OK;
    const struct submission *s = &r->submission;
    struct text t = {0};
    struct path path;
    if (!r->dry_run) {
        TRY(farm_freeze(f));
        TRY(submission_write(f->root.text, s));
        TRY(path_join(&path, f->root.text, "log/farm.log"));
        TRY(log_open(path.text));
    }
    answer_begin(&t);
    json_text(&t, "name", f->base->name);
    json_text(&t, "folder", f->root.text);
    TRY(slurm_submit(
        f,
        &(struct slurm_options){
            .device = s->device, .extra = s->extra, .n_extra = s->n_extra, .dry_run = r->dry_run},
        &t));
    json_end_object(&t);
    TRY(answer_print(&t, r->json));
done:
    text_free(&t);
    return st;
}

/* ---- OpenJD */

static status to_openjd(const struct submit_request *r, struct farm *f)
{
    status st = OK;
    struct text t = {0};
    struct path path;
    TRY(openjd_template(f, r->submission.device, &t));
    if (r->dry_run) {
        fputs(t.data, stdout);
        goto done;
    }
    TRY(farm_freeze(f));
    TRY(submission_write(f->root.text, &r->submission));
    TRY(path_format(&path, "%s/%s.openjd.json", f->root.text, f->base->name));
    TRY(atomic_file_write(path.text, t.data, t.size));
    log_info("%s: submit it with your farm's client, or try it with 'openjd run %s --step ...'", path.text,
             path.text);
done:
    text_free(&t);
    return st;
}

/* ---- Deadline Cloud */

static status to_deadline(const struct submit_request *r, struct farm *f)
{
    status st = OK;
    struct deadline_bundle b = {0};
    struct path folder;
    if (!r->dry_run)
        TRY(farm_freeze(f));
    TRY(deadline_bundle(f, r->submission.device, &b));
    if (r->dry_run) {
        fputs(b.template.data, stdout);
        goto done;
    }
    TRY(submission_write(f->root.text, &r->submission));
    TRY(deadline_write(f, &b, &folder));
    log_info("%s: submit it with: deadline bundle submit %s", folder.text, folder.text);
done:
    deadline_bundle_free(&b);
    return st;
}

/* ---- any other farm: the tasks as data */

static status describe_tasks(const struct submit_request *r, const struct farm *f, bool words, struct text *t)
{
    status st = OK;
    answer_begin(t);
    json_text(t, "name", f->base->name);
    json_text(t, "folder", f->root.text);
    TRY(farm_describe(f, words, r->submission.device, t));
    json_end_object(t);
    TRY(text_status(t));
done:
    return st;
}

static status print_tasks(const struct submit_request *r, const struct farm *f, bool as_json)
{
    status st = OK;
    struct text t = {0};
    TRY(describe_tasks(r, f, !as_json, &t));
    TRY(answer_print(&t, as_json));
done:
    text_free(&t);
    return st;
}

static status to_tasks(const struct submit_request *r, struct farm *f)
{
    status st = OK;
    if (!r->dry_run) {
        TRY(farm_freeze(f));
        TRY(submission_write(f->root.text, &r->submission));
    }
    TRY(print_tasks(r, f, true));
done:
    return st;
}

/* ---- OpenCue */

static status to_opencue(const struct submit_request *r, struct farm *f)
{
    status st = OK;
    struct text outline = {0}, tasks = {0};
    struct path path, to;
    if (!r->dry_run)
        TRY(farm_freeze(f));
    TRY(path_join(&path, f->root.text, "farm/tasks.json"));
    TRY(opencue_outline(f, path.text, &outline));
    if (r->dry_run) {
        fputs(outline.data, stdout);
        goto done;
    }
    TRY(describe_tasks(r, f, false, &tasks));
    TRY(submission_write(f->root.text, &r->submission));
    TRY(atomic_file_write(path.text, tasks.data, tasks.size));
    TRY(path_format(&to, "%s/%s.outline", f->root.text, f->base->name));
    TRY(atomic_file_write(to.text, outline.data, outline.size));
    log_info("%s: submit it with: pycuerun %s", to.text, to.text);
done:
    text_free(&outline);
    text_free(&tasks);
    return st;
}

status submit_tasks(const struct submit_request *r, struct farm *f)
{
    switch (r->submission.to) {
    case TO_LOCAL:
        return r->dry_run ? print_tasks(r, f, r->json) : to_local(r, f);
    case TO_SLURM:
        return to_slurm(r, f);
    case TO_OPENJD:
        return to_openjd(r, f);
    case TO_DEADLINE:
        return to_deadline(r, f);
    case TO_OPENCUE:
        return to_opencue(r, f);
    default:
        return to_tasks(r, f);
    }
}

/* ---- the verb */

static status take_extra(const struct arguments *operands, struct submission *s)
{
    if (s->to != TO_SLURM && operands->n > 1)
        return fail(
            E_USAGE,
            "submit: unexpected argument '%.80s': only --to slurm takes more arguments, which are for sbatch",
            operands->item[1]);
    if (operands->n - 1 > SUBMISSION_EXTRA)
        return fail(E_USAGE, "submit: %zu arguments for sbatch; at most %d", operands->n - 1,
                    SUBMISSION_EXTRA);
    for (size_t i = 1; i < operands->n; i++)
        s->extra[s->n_extra++] = operands->item[i];
    return OK;
}

/* Frame times, on which time limits and notices rest: of the folder's frames, or rehearsed on a device of this machine. */
static status time_frames(const struct plan_asked *asked, const char *device, struct farm *f)
{
    status st = OK;
    struct gpu *gpu = NULL;
    struct plan_time time = {0};
    if (asked->patience > 0)
        TRY(gpu_create(&(struct gpu_options){.device = device}, &gpu));
    TRY(plan_frame_times(asked, gpu, f, &time));
done:
    gpu_destroy(&gpu);
    return st;
}

status cli_submit(int argc, char **argv)
{
    status st = OK;
    struct common c = {0};
    struct submit_request request = {.submission.to = -1};
    struct submission *s = &request.submission;
    struct arguments operands = {0};
    struct farm farm = {0};
    struct plan_asked asked = {.common = &c};
    bool help = false, change = false;
    const struct option options[] = {
        {"to", CHOICE_TEXT(SUBMIT_TO_CHOICE), OPTION_CHOICE, &s->to,
         "this machine's devices; sbatch; a job template (jobtemplate-2023-09); a job bundle of AWS Deadline Cloud; or, for any other farm, the tasks as JSON on stdout: each with its command, what it waits for and what it needs"},
        OPTION_OUT(&c),
        {"dry-run", NULL, OPTION_FLAG, &request.dry_run, "print what would be submitted, and do nothing"},
        {"gpus", "LIST", OPTION_TEXT, &s->gpus, "local: a worker for each of these devices, such as 0,1"},
        {"workers", "N", OPTION_INT, &s->workers, "local: this many workers that share the CPU"},
        {"rehearse", "SECONDS", OPTION_NUMBER, &asked.patience,
         "for time limits: how long to time the first frames on this machine's device, if the folder has none yet (default 0: no rehearsal)"},
        {"continue", NULL, OPTION_FLAG, &change,
         "the job was changed from some frame on since it ran in this folder: keep the frames before, and submit what is behind; says first what is overwritten"},
        OPTION_DEVICE(&c),
        OPTION_SET(&c),
        OPTION_FROM(&c),
        OPTION_WEDGE(&s->wedge),
        OPTION_PROGRESS(&c),
        OPTION_JSON(&c),
    };
    TRY(options_parse(&usage_submit, options, sizeof options / sizeof *options, argc, argv, &operands,
                      &help));
    if (help)
        goto done;
    if (s->to < 0) {
        st = fail(E_USAGE, "submit: --to is missing: --to local, slurm, openjd, deadline, opencue or tasks");
        goto done;
    }
    if (asked.patience < 0) {
        st = fail(E_USAGE, "submit: --rehearse %g: must be 0 seconds or more", asked.patience);
        goto done;
    }
    TRY(take_extra(&operands, s));
    s->device = c.device;
    request.progress = c.progress;
    request.json = c.json;
    asked.path = operands.item[0];
    TRY(farm_load(asked.path, c.sets.item, c.sets.n, c.from, s->wedge, c.out, &farm));
    for (size_t i = 0; i < farm.n_wedges && i < WARNED; i++)
        TRY(advice_log(farm.wedge[i].job, false));
    if (change)
        TRY(farm_change(&farm, request.dry_run));
    TRY(time_frames(&asked, s->to == TO_SLURM ? NULL : s->device, &farm));
    TRY(farm_graph(&farm));
    TRY(submit_tasks(&request, &farm));
done:
    farm_free(&farm);
    arguments_free(&operands);
    common_free(&c);
    return st;
}
