#include "farm/status.h"

#include <ctype.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/log.h"
#include "farm/farm.h"
#include "farm/slurm_jobs.h"
#include "farm/submission.h"
#include "farm/tries.h"
#include "output/folder.h"

static status job_path(const char *root, struct path *out)
{
    return path_join(out, root, "farm/job.yaml");
}

bool farm_is(const char *root)
{
    struct path path;
    return job_path(root, &path) == OK && access(path.text, F_OK) == 0;
}

status farm_has_wedges(const char *root, bool *yes)
{
    struct path path;
    struct job *job = NULL;
    *yes = false;
    if (!farm_is(root) || job_path(root, &path) != OK)
        return OK;
    status st = job_load(path.text, NULL, 0, &job);
    if (st == OK)
        *yes = job_wedges(job) > 0;
    job_destroy(&job);
    return st;
}

static void put_wedges(const struct farm *f, struct text *out)
{
    json_array(out, "wedges");
    for (size_t i = 0; i < f->n_wedges; i++) {
        const struct job *job = f->wedge[i].job;
        const size_t done = farm_frames_of(f, job);
        json_object(out, NULL);
        json_integer(out, "wedge", job->wedge.index);
        json_integer(out, "done", (int64_t)done);
        json_integer(out, "total", (int64_t)range_count(job->frames));
        json_text(out, "values", job->wedge.label);
        json_end_object(out);
    }
    json_end_array(out);
}

/* The state of a task that is not done: Slurm's, or else what its tries say. */
static void state_of(const struct slurm_job *job, const struct farm_tries *tries, bool local, char out[32],
                     const char **reason)
{
    static const char *const stranded =
        "no node of its partition can run it: install hoodoo there, or set farm.binary or --partition, then retry";
    *reason = tries->stranded ? stranded : "";
    if (job && *job->id && *job->state) {
        snprintf(out, 32, "%s", job->state);
        for (char *c = out; *c; c++)
            *c = (char)tolower((unsigned char)*c);
        if (!tries->stranded && strcmp(job->reason, "None") != 0)
            *reason = job->reason;
        return;
    }
    snprintf(out, 32, "%s",
             tries->cancelled                        ? "cancelled"
             : tries->running && local               ? "running"
             : tries->running                        ? "lost"
             : tries->exit_code > 0 && tries->starts ? "failed"
             : job && *job->id                       ? "ended"
                                                     : "to do");
    if (tries->exit_code == STOPPED && !tries->running && !tries->cancelled)
        snprintf(out, 32, "stopped");
    if (tries->running && !local)
        *reason = "its process ended without reporting an exit code: see its log, then retry";
    else if (strcmp(out, "ended") == 0)
        *reason = "Slurm no longer knows its job, and it is not done: see its log, then retry";
}

static status put_task(const struct farm *f, const struct farm_task *t, const struct slurm_job *job,
                       bool local, bool words, struct text *out)
{
    status st = OK;
    struct farm_tries tries;
    struct path log;
    char state[32], meaning[160];
    const char *reason;
    TRY(tries_read(f, t, &tries));
    TRY(path_format(&log, "log/farm/%s.log", t->name));
    state_of(job, &tries, local, state, &reason);
    const char *node = job && *job->node ? job->node : tries.node,
               *says = tries.exit_code < 0 ? "" : farm_exit_meaning(tries.exit_code, meaning);
    char code[16] = "", last[200] = "";
    if (tries.exit_code >= 0) {
        snprintf(code, sizeof code, "%d", tries.exit_code);
        snprintf(last, sizeof last, "%d: %s", tries.exit_code, says);
    }
    json_object(out, NULL);
    json_text(out, "task", t->name);
    json_text(out, "state", state);
    json_integer(out, "tries", tries.starts);
    json_text(out, "exit", words ? last : code);
    if (!words)
        json_text(out, "meaning", says);
    json_text(out, "node", node);
    if (!words)
        json_text(out, "excluded_nodes", tries.excluded);
    json_integer(out, "elapsed_seconds", (int64_t)tries.seconds);
    json_text(out, "job", job ? job->id : "");
    json_text(out, "reason", reason);
    json_text(out, "log", tries.starts ? log.text : "");
    json_end_object(out);
done:
    return st;
}

/* Whether the process that hands out the tasks of a local submission lives; true too if it is elsewhere. */
static bool runs_here(const char *root)
{
    struct submission s;
    if (submission_read(root, &s) != OK)
        return false;
    const bool lives = s.to == TO_LOCAL && s.process.pid && process_fate(&s.process) != PROCESS_GONE;
    submission_free(&s);
    return lives;
}

status farm_status(const char *root, bool words, struct text *out)
{
    status st = OK;
    struct farm f = {0};
    struct slurm_job *jobs = NULL;
    size_t n_done = 0;
    const bool local = runs_here(root);
    TRY(farm_open(root, &f));
    if (slurm_jobs(&f, &jobs) != OK)
        log_warn("Slurm's view of the tasks is missing: %s", status_message());
    if (f.wedge[0].job->wedge.index)
        put_wedges(&f, out);
    json_array(out, "tasks");
    for (size_t i = 0; i < f.graph.n; i++) {
        bool done;
        TRY(farm_task_done(&f, &f.graph.task[i], &done));
        n_done += done;
        if (!done)
            TRY(put_task(&f, &f.graph.task[i], jobs ? &jobs[i] : NULL, local, words, out));
    }
    json_end_array(out);
    json_integer(out, "tasks_done", (int64_t)n_done);
    json_integer(out, "task_count", (int64_t)f.graph.n);
done:
    free(jobs);
    farm_free(&f);
    return st;
}
