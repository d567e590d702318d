#include "farm/status.h"

#include <ctype.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/log.h"
#include "farm/farm.h"
#include "farm/slurm_jobs.h"
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

/* What there is to say of a task that is not done. */
static void put_task(const struct farm_task *t, const struct slurm_job *job, struct text *out)
{
    char state[32] = "to do";
    const char *reason = "";
    if (job && *job->id) {
        snprintf(state, sizeof state, "%s", *job->state ? job->state : "ended");
        for (char *c = state; *c; c++)
            *c = (char)tolower((unsigned char)*c);
        reason = !*job->state ? "Slurm knows it no more and it is not done: see its log, submit again"
                 : strcmp(job->reason, "None") == 0 ? ""
                                                    : job->reason;
    }
    json_object(out, NULL);
    json_text(out, "task", t->name);
    json_text(out, "state", state);
    json_text(out, "job", job ? job->id : "");
    json_text(out, "reason", reason);
    json_end_object(out);
}

status farm_status(const char *root, struct text *out)
{
    status st = OK;
    struct path path;
    struct farm f = {0};
    struct slurm_job *jobs = NULL;
    size_t n_done = 0;
    TRY(job_path(root, &path));
    TRY(farm_load(path.text, NULL, 0, NULL, 0, root, &f));
    TRY(farm_graph(&f));
    if (slurm_jobs(&f, &jobs) != OK)
        log_warn("what Slurm thinks is not known: %s", status_message());
    if (f.wedge[0].job->wedge.index)
        put_wedges(&f, out);
    json_array(out, "tasks");
    for (size_t i = 0; i < f.graph.n; i++) {
        bool done;
        TRY(farm_task_done(&f, &f.graph.task[i], &done));
        n_done += done;
        if (!done)
            put_task(&f.graph.task[i], jobs ? &jobs[i] : NULL, out);
    }
    json_end_array(out);
    json_integer(out, "tasks_done", (int64_t)n_done);
    json_integer(out, "task_count", (int64_t)f.graph.n);
done:
    free(jobs);
    farm_free(&f);
    return st;
}
