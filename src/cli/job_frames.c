#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

#include "cli/cli.h"
#include "job/job.h"
#include "output/folder.h"

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

status volume_frames(const char *root, const char *name, struct frame_range range, int **out, size_t *n)
{
    status st = OK;
    int *frames = NULL;
    size_t n_all;
    char path[4096], asked[48];
    *n = 0;
    TRY(folder_frames(root, name, &frames, &n_all));
    for (size_t i = 0; i < n_all; i++) {
        if (range.step && !range_holds(range, frames[i]))
            continue;
        TRY(folder_path(path, root, name, FILE_VOLUMES, frames[i], NULL));
        if (access(path, R_OK) == 0)
            frames[(*n)++] = frames[i];
    }
    if (*n == 0) {
        st = fail(E_INPUT, "%s holds no volumes of %s; run the job first", root,
                  range.step ? range_text(range, asked) : "any frame");
        goto done;
    }
    *out = frames;
    frames = NULL;
done:
    free(frames);
    return st;
}
