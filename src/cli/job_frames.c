#include <stdio.h>

#include "cli/cli.h"
#include "job/job.h"

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

status wedge_folder(const char *root, int wedge, char out[4096])
{
    int n = wedge ? snprintf(out, 4096, "%s/w%04d", root, wedge) : snprintf(out, 4096, "%s", root);
    if (wedge < 0 || wedge > 9999)
        return fail(E_USAGE, "--wedge %d: 1 to 9999", wedge);
    return n < 0 || n >= 4096 ? fail(E_INPUT, "%.200s...: the path is too long", root) : OK;
}
