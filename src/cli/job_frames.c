#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "cli/cli.h"
#include "job/job.h"
#include "output/folder.h"

status job_frames(const char *root, struct frame_range *out)
{
    struct path path;
    struct job *job = NULL;
    status st = OK;
    TRY(path_join(&path, root, "job.yaml"));
    TRY(job_load(path.text, NULL, 0, &job));
    *out = job->frames;
done:
    job_destroy(&job);
    return st;
}

status wedge_folder(const char *root, int wedge, struct path *out)
{
    if (wedge < 0 || wedge > WEDGE_MAX)
        return fail(E_USAGE, "--wedge %d: must be 1 to %d", wedge, WEDGE_MAX);
    return path_wedge(out, root, wedge) == OK ? OK : fail(E_USAGE, "%s", status_message());
}

status volume_frames(const char *root, const char *name, struct frame_range range, int **out, size_t *n)
{
    status st = OK;
    int *frames = NULL;
    size_t n_all;
    struct path path;
    char asked[48];
    *n = 0;
    TRY(folder_frames(root, name, &frames, &n_all));
    for (size_t i = 0; i < n_all; i++) {
        if (range.step && !range_holds(range, frames[i]))
            continue;
        TRY(folder_path(&path, root, name, FILE_VOLUMES, frames[i], NULL));
        if (access(path.text, R_OK) == 0) {
            frames[(*n)++] = frames[i];
        } else if (errno != ENOENT) {
            st = fail(E_INPUT, "%s: %s", path.text, strerror(errno));
            goto done;
        }
    }
    if (*n == 0) {
        st = fail(E_INPUT, "%s: no volumes of %s; run the job first", root,
                  range.step ? range_text(range, asked) : "any frame");
        goto done;
    }
    *out = frames;
    frames = NULL;
done:
    free(frames);
    return st;
}
