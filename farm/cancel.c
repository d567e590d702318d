#include "farm/cancel.h"

#include <errno.h>
#include <signal.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "base/clock.h"
#include "base/memory.h"
#include "farm/slurm_jobs.h"
#include "farm/submission.h"
#include "farm/tries.h"

static status cancel_slurm(const struct farm *f, struct text *out)
{
    status st = OK;
    char(*job)[SLURM_ID] = NULL;
    TRY(memory_alloc(f->graph.n, sizeof *job, "the jobs", &job));
    TRY(slurm_active(f, job));
    TRY(slurm_cancel((const char(*)[SLURM_ID])job, f->graph.n));
    for (size_t i = 0; i < f->graph.n; i++)
        if (*job[i]) {
            TRY(tries_add(f, &f->graph.task[i], "cancelled"));
            json_text(out, NULL, f->graph.task[i].name);
        }
done:
    free(job);
    return st;
}

/* Tasks that run when the process is told to stop. */
static status running_tasks(const struct farm *f, struct text *out)
{
    status st = OK;
    struct farm_tries tries;
    for (size_t i = 0; i < f->graph.n; i++) {
        TRY(tries_read(f, &f->graph.task[i], &tries));
        if (tries.running)
            json_text(out, NULL, f->graph.task[i].name);
    }
done:
    return st;
}

static status cancel_local(const struct farm *f, const struct submission *s, struct text *out)
{
    enum { PATIENCE_S = 600 }; /* a frame may take long, and a simulation saves between frames */
    const struct timespec pause = {.tv_nsec = 50000000};
    const struct process_id *p = &s->process;
    const double began = clock_seconds();
    if (!p->pid || process_fate(p) == PROCESS_GONE)
        return OK;
    if (process_fate(p) == PROCESS_UNKNOWN)
        return fail(E_USAGE, "%s: its tasks are run by process %ld on %s: run 'hoodoo cancel' there",
                    f->root.text, p->pid, p->host);
    status st = running_tasks(f, out);
    if (st != OK)
        return st;
    if (kill((pid_t)p->pid, SIGTERM) != 0 && errno != ESRCH)
        return fail(E_OUTPUT, "process %ld, which runs the tasks of %s, cannot be stopped: %s", p->pid,
                    f->root.text, strerror(errno));
    while (process_fate(p) == PROCESS_LIVES) {
        if (clock_seconds() - began > PATIENCE_S)
            return fail(E_OUTPUT,
                        "process %ld was told to stop and still saves after %d s: see %s/log/farm.log",
                        p->pid, PATIENCE_S, f->root.text);
        nanosleep(&pause, NULL);
    }
    return OK;
}

status farm_cancel(const struct farm *f, struct text *out)
{
    status st = OK;
    struct submission s = {.to = -1};
    TRY(submission_read(f->root.text, &s));
    if (s.to != TO_LOCAL && s.to != TO_SLURM) {
        st = fail(E_USAGE, "%s was submitted to %s: cancel its tasks there", f->root.text,
                  submission_name(s.to));
        goto done;
    }
    json_text(out, "to", submission_name(s.to));
    json_array(out, "cancelled");
    TRY(s.to == TO_SLURM ? cancel_slurm(f, out) : cancel_local(f, &s, out));
    json_end_array(out);
done:
    submission_free(&s);
    return st;
}
