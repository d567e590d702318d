#include <stdio.h>

#include "cli/cli.h"
#include "job/job.h"
#include "model/branch.h"

status load_job(const char *path, struct common *c, struct job **job, char root[4096])
{
    status st = OK;
    /* A branch may have edits before its first frame. Which checkpoint it is follows below: it may be in the output
     * folder, which may be named by the job. */
    if (c->from)
        TRY(words_add(&c->sets, "from=checkpoint"));
    TRY(job_load(path, c->sets.word, c->sets.n, job));
    int n = c->out ? snprintf(root, 4096, "%s", c->out) : snprintf(root, 4096, "out/%s", (*job)->name);
    if (n < 0 || n >= 4096 - 200)
        return fail(E_USAGE, "--out: the path is too long");
    if (c->from)
        TRY(branch_from(*job, c->from, root));
done:
    return st;
}

status job_frames(const char *root, struct frame_range *out)
{
    char path[4096];
    struct job *job = NULL;
    status st = OK;
    if (snprintf(path, sizeof path, "%s/job.yaml", root) >= (int)sizeof path)
        return fail(E_INPUT, "%.200s...: the path is too long", root);
    TRY(job_load(path, NULL, 0, &job));
    *out = job->frames;
done:
    job_destroy(&job);
    return st;
}
