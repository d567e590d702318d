/* hoodoo submit --continue: a submitted job that was changed from some frame on. */
#include <stdlib.h>

#include "base/memory.h"
#include "farm/farm.h"
#include "farm/slurm_jobs.h"
#include "farm/submission.h"
#include "run/run.h"

status farm_check_alone(const char *root)
{
    struct submission s;
    status st = submission_read(root, &s);
    if (st == OK && s.to == TO_LOCAL && s.process.pid && process_fate(&s.process) == PROCESS_LIVES)
        st = fail(E_OUTPUT,
                  "the tasks of %s are run by process %ld already: wait for it, or 'hoodoo cancel' it first",
                  root, s.process.pid);
    submission_free(&s);
    return st;
}

/* E_OUTPUT: tasks that were submitted to Slurm wait or run. They would read the changed job. */
static status check_queue(const char *root)
{
    status st = OK;
    struct submission s = {0};
    struct farm before = {0};
    char(*job)[SLURM_ID] = NULL;
    TRY(submission_read(root, &s));
    if (s.to != TO_SLURM)
        goto done;
    TRY(farm_open(root, &before));
    TRY(memory_alloc(before.graph.n, sizeof *job, "the jobs", &job));
    TRY(slurm_active(&before, job));
    for (size_t i = 0; i < before.graph.n; i++)
        if (*job[i]) {
            st = fail(E_OUTPUT,
                      "%s: task %s is Slurm's job %s: wait for it, or 'hoodoo cancel' the tasks first", root,
                      before.graph.task[i].name, job[i]);
            goto done;
        }
done:
    free(job);
    farm_free(&before);
    submission_free(&s);
    return st;
}

status farm_change(struct farm *f, bool dry_run)
{
    status st = OK;
    struct path root;
    TRY(farm_check_alone(f->root.text));
    TRY(check_queue(f->root.text));
    /* First all are checked, so that a refusal leaves all as they were. */
    for (int change = 0; change < (dry_run ? 1 : 2); change++)
        for (size_t i = 0; i < f->n_wedges; i++) {
            TRY(farm_root(f, (int)f->wedge[i].job->wedge.index, &root));
            TRY(run_take_over(f->wedge[i].job, root.text, change));
        }
done:
    return st;
}
