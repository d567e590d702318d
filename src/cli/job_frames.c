#include <stdio.h>

#include "cli/cli.h"
#include "job/job.h"

status output_folder(const struct common *c, const struct job *job, char root[4096])
{
    int n = c->out ? snprintf(root, 4096, "%s", c->out) : snprintf(root, 4096, "out/%s", job->name);
    return n < 0 || n >= 4096 - 200 ? fail(E_USAGE, "--out: the path is too long") : OK;
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
