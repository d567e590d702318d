/* How far a farm's tasks are, as the files tell. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/stat.h>

#include "base/memory.h"
#include "checkpoint/checkpoint.h"
#include "farm/farm.h"
#include "output/folder.h"

static double modified(const char *path)
{
    struct stat info;
    return stat(path, &info) == 0 ? (double)info.st_mtim.tv_sec + 1e-9 * (double)info.st_mtim.tv_nsec : 0;
}

static int ascending(const void *a, const void *b)
{
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

double farm_frame_seconds(const char *root, const char *name)
{
    enum { RECENT = 50, LEAST = 3 };
    char path[4096];
    int *frames = NULL;
    size_t n = 0, k = 0;
    double *at = NULL, each = 0;
    if (folder_frames(root, name, &frames, &n) != OK || n < LEAST ||
        memory_alloc(n, sizeof *at, "the frames' times", &at) != OK)
        goto done;
    for (size_t i = 0; i < n; i++)
        if (folder_path(path, root, name, FILE_MANIFEST, frames[i], NULL) == OK)
            at[k++] = modified(path);
    qsort(at, k, sizeof *at, ascending);
    size_t first = k > RECENT ? k - RECENT : 0;
    for (size_t i = first; i + 1 < k; i++)
        at[i] = at[i + 1] - at[i];
    if (k > first + 1) {
        qsort(at + first, k - first - 1, sizeof *at, ascending);
        each = at[first + (k - first - 1) / 2];
    }
done:
    free(frames);
    free(at);
    return each;
}

int farm_notice_seconds(const struct farm_wedge *wedge, size_t n_wedges, int least, int most)
{
    enum { SAVE_S = 60 };
    double longest = 0;
    for (size_t i = 0; i < n_wedges; i++)
        longest = fmax(longest, wedge[i].frame_seconds);
    return (int)fmin(fmax(ceil(2 * longest + SAVE_S), least), most);
}

size_t farm_frames(const struct farm *f, size_t *total)
{
    char root[FARM_PATH + 16];
    size_t done = 0;
    *total = 0;
    for (size_t i = 0; i < f->n_wedges; i++) {
        const struct job *job = f->wedge[i].job;
        int *frames = NULL;
        size_t n = 0;
        farm_root(f, (int)job->wedge.index, root);
        *total += range_count(job->frames);
        if (folder_frames(root, job->name, &frames, &n) == OK)
            for (size_t k = 0; k < n; k++)
                done += range_holds(job->frames, frames[k]);
        free(frames);
    }
    return done;
}

static status sim_done(const char *root, const struct job *job, struct frame_range frames, bool *done)
{
    status st = OK;
    int *list = NULL;
    size_t n;
    uint64_t hash;
    TRY(job_hash(job, &hash));
    TRY(checkpoint_list(root, job->name, &list, &n));
    *done = n > 0 && list[0] >= frames.last;
    for (int frame = frames.first; *done && frame <= frames.last; frame += frames.step) {
        struct manifest m = {0};
        const char *bad = "";
        st = manifest_read(root, job->name, frame, &m);
        if (st == OK)
            st = manifest_check(root, &m, false, &bad);
        *done = st == OK && !*bad && m.job_hash == hash;
        manifest_free(&m);
        if (st != E_MEMORY)
            st = OK; /* missing or damaged is no error here */
        TRY(st);
    }
done:
    free(list);
    return st;
}

/* Is the file there, no older than what it is made of? */
static bool current(const char *root, const char *made, const char *from)
{
    char path[FARM_PATH + 600];
    snprintf(path, sizeof path, "%s/%s", root, made);
    double a = modified(path);
    snprintf(path, sizeof path, "%s/%s", root, from);
    return a > 0 && a >= modified(path);
}

status farm_task_done(const struct farm *f, const struct farm_task *t, bool *done)
{
    char root[FARM_PATH + 16], made[256], from[256];
    const struct job *job = farm_job(f, t);
    const char *name = job->name;
    int last = job->frames.last;
    farm_root(f, t->wedge, root);
    *done = true;
    for (int frame = t->frames.first; frame <= t->frames.last && *done; frame += t->frames.step)
        switch (t->kind) {
        case FARM_SIM:
            return sim_done(root, job, t->frames, done);
        case FARM_MESH:
            snprintf(made, sizeof made, "mesh/%s.%04d.obj", name, frame);
            snprintf(from, sizeof from, "volumes/%s.%04d.vdb", name, frame);
            *done = !graph_has_volumes(job, frame) || current(root, made, from);
            break;
        case FARM_AOV:
            snprintf(from, sizeof from, "volumes/%s.%04d.vdb", name, frame);
            for (size_t i = 0; i < job->farm.n_cameras && *done; i++) {
                snprintf(made, sizeof made, "aov/%s.%s.%04d.exr", name, job->farm.cameras[i], frame);
                *done = !graph_has_volumes(job, frame) || current(root, made, from);
            }
            break;
        case FARM_STILL:
            snprintf(made, sizeof made, "preview/%s.%04d.png", name, frame);
            snprintf(from, sizeof from, "volumes/%s.%04d.vdb", name, frame);
            *done = !graph_has_still(job, frame) || current(root, made, from);
            break;
        case FARM_SHOW:
            snprintf(made, sizeof made, "preview/%s.%.15s.%04d.png", name, t->show, frame);
            snprintf(from, sizeof from, "volumes/%s.%04d.vdb", name, frame);
            *done = !graph_has_still(job, frame) || current(root, made, from);
            break;
        case FARM_SHEET:
            snprintf(made, sizeof made, "%s.contact.png", name);
            snprintf(from, sizeof from, "preview/%s.%04d.png", name, frame);
            *done = !graph_has_still(job, frame) || current(root, made, from);
            break;
        case FARM_VIEW:
            snprintf(from, sizeof from, "volumes/%s.%04d.vdb", name, last);
            for (int view = t->views.first; view <= t->views.last && *done; view++) {
                snprintf(made, sizeof made, "turntable/%s.%04d.%03d.png", name, last, view);
                *done = current(root, made, from);
            }
            break;
        case FARM_TURNTABLE:
            snprintf(made, sizeof made, "%s.turntable.mp4", name);
            snprintf(from, sizeof from, "volumes/%s.%04d.vdb", name, last);
            *done = current(root, made, from);
            break;
        case FARM_WEDGES:
        case FARM_KINDS:
            snprintf(made, sizeof made, "%s.wedges.png", f->base->name);
            *done = true;
            for (size_t i = 0; i < f->n_wedges && *done; i++) {
                const struct job *w = f->wedge[i].job;
                snprintf(from, sizeof from, "w%04d/preview/%s.%04d.png", (int)w->wedge.index, w->name,
                         w->frames.last);
                *done = current(root, made, from);
            }
            break;
        }
    return OK;
}
