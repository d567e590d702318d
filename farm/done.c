/* Which tasks of a farm are done, from the files that exist. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "base/memory.h"
#include "checkpoint/checkpoint.h"
#include "farm/farm.h"
#include "output/product.h"

int farm_notice_seconds(const struct farm_wedge *wedge, size_t n_wedges, int least, int most)
{
    enum { SAVE_S = 60 };
    double longest = 0;
    for (size_t i = 0; i < n_wedges; i++)
        longest = fmax(longest, wedge[i].frame_seconds);
    return (int)fmin(fmax(ceil(2 * longest + SAVE_S), least), most);
}

size_t farm_frames_of(const struct farm *f, const struct job *wedge)
{
    struct path root;
    int *frames = NULL;
    size_t n = 0, done = 0;
    if (farm_root(f, (int)wedge->wedge.index, &root) == OK &&
        folder_frames(root.text, wedge->name, &frames, &n) == OK)
        for (size_t k = 0; k < n; k++)
            done += range_holds(wedge->frames, frames[k]);
    free(frames);
    return done;
}

size_t farm_frames(const struct farm *f, size_t *total)
{
    size_t done = 0;
    *total = 0;
    for (size_t i = 0; i < f->n_wedges; i++) {
        *total += range_count(f->wedge[i].job->frames);
        done += farm_frames_of(f, f->wedge[i].job);
    }
    return done;
}

static status sim_done(const char *root, const struct job *job, struct frame_range frames, bool *done)
{
    status st = OK;
    int *list = NULL;
    size_t n;
    struct job_states states = {0};
    TRY(job_states(job, &states));
    TRY(checkpoint_list(root, job->name, &list, &n));
    *done = n > 0 && list[0] >= frames.last;
    for (int frame = frames.first; *done && frame <= frames.last; frame += frames.step) {
        struct manifest m = {0};
        const char *bad = "";
        st = manifest_read(root, job->name, frame, &m);
        if (st == OK)
            st = manifest_check(root, &m, false, &bad);
        *done = st == OK && !*bad && job_states_hold(&states, frame, m.job_hash);
        manifest_free(&m);
        if (st != E_MEMORY)
            st = OK; /* a missing or damaged manifest is not an error here */
        TRY(st);
    }
done:
    job_states_free(&states);
    free(list);
    return st;
}

/* A picture on a sheet: the folder of its wedge, its path there, and its path in the folder of the sheet. */
struct shown {
    struct path root, path, listed;
};

/* *done: whether the product root/`made` has the size in its record and was made from the existing frame, or from the picture `shows` as its
 * record has it now. */
static status product_current(const char *root, const char *name, const char *made, const struct shown *shows,
                              bool *done)
{
    struct product p, picture = {0};
    status st = product_read(root, made, &p);
    if (st == OK)
        st = product_check(root, name, &p, false);
    if (st == OK && shows)
        st = product_read(shows->root.text, shows->path.text, &picture);
    *done = st == OK && (!shows || product_shows(&p, shows->listed.text, picture.file.hash));
    product_free(&picture);
    product_free(&p);
    return st == E_MEMORY ? st : OK;
}

/* *done stays true if all files that the task makes of the frame are current. */
static status frame_done(const struct farm *f, const struct farm_task *t, int frame, bool *done)
{
    status st = OK;
    const struct farm_kind_info *kind = &farm_kinds[t->kind];
    const struct job *job = farm_job(f, t);
    const size_t n = kind->parts ? kind->parts(job) : 1;
    struct path root, made;
    struct shown still;
    TRY(farm_root(f, t->wedge, &root));
    still.root = root;
    TRY(folder_name(&still.path, job->name, kind->from, frame, NULL));
    still.listed = still.path;
    for (size_t i = 0; i < n && *done; i++) {
        const char *part = kind->part ? kind->part(job, i) : t->show;
        TRY(folder_name(&made, job->name, kind->makes, frame, part));
        TRY(product_current(root.text, job->name, made.text, kind->from == FILE_VOLUMES ? NULL : &still,
                            done));
    }
done:
    return st;
}

static status views_done(const struct farm *f, const struct farm_task *t, bool *done)
{
    status st = OK;
    const struct job *job = farm_job(f, t);
    const int frame = t->frames.last;
    struct path root, made;
    TRY(farm_root(f, t->wedge, &root));
    for (int view = t->views.first; view <= t->views.last && *done; view++) {
        TRY(folder_view(&made, job->name, t->show, frame, view));
        TRY(product_current(root.text, job->name, made.text, NULL, done));
    }
done:
    return st;
}

/* The same for a task of all wedges, whose product is made from the last frame of each wedge. */
static status across_done(const struct farm *f, const struct farm_task *t, bool *done)
{
    status st = OK;
    const struct farm_kind_info *kind = &farm_kinds[t->kind];
    struct path made;
    struct shown still;
    char number[FRAME_TEXT];
    TRY(folder_name(&made, f->base->name, kind->makes, 0, NULL));
    for (size_t i = 0; i < f->n_wedges && *done; i++) {
        const struct job *job = f->wedge[i].job;
        const int wedge = (int)job->wedge.index;
        TRY(farm_root(f, wedge, &still.root));
        TRY(folder_name(&still.path, job->name, kind->from, job->frames.last, NULL));
        TRY(path_join(&still.listed, wedge_text(wedge, number), still.path.text));
        TRY(product_current(f->root.text, job->name, made.text, &still, done));
    }
done:
    return st;
}

status farm_task_outputs(const struct farm *f, const struct farm_task *t,
                         status (*each)(void *user, const char *path), void *user)
{
    status st = OK;
    const struct farm_kind_info *kind = &farm_kinds[t->kind];
    const struct job *job = farm_job(f, t);
    const size_t n = kind->parts ? kind->parts(job) : 1;
    struct path file, path;
    char number[FRAME_TEXT], prefix[FRAME_TEXT + 2] = "";
    if (kind->cut == CUT_JOB)
        return OK;
    if (t->wedge)
        snprintf(prefix, sizeof prefix, "%s/", wedge_text(t->wedge, number));
    if (kind->cut == CUT_VIEWS) {
        for (int view = t->views.first; view <= t->views.last; view++) {
            TRY(folder_view(&file, job->name, t->show, t->frames.last, view));
            TRY(path_format(&path, "%s%s", prefix, file.text));
            TRY(each(user, path.text));
        }
        return OK;
    }
    const bool many = kind->cut == CUT_BLOCKS || kind->cut == CUT_CHUNKS || kind->cut == CUT_LIST;
    const struct frame_range last = {t->frames.last, t->frames.last, 1}, frames = many ? t->frames : last;
    for (int frame = frames.first; frame <= frames.last; frame += frames.step)
        for (size_t i = 0; i < n; i++) {
            const char *part = kind->part ? kind->part(job, i) : t->show;
            if (many && kind->takes && !kind->takes(job, frame))
                continue;
            TRY(folder_name(&file, kind->cut == CUT_ALL_WEDGES ? f->base->name : job->name,
                            kind->cut == CUT_BLOCKS ? FILE_MANIFEST : kind->makes, frame, part));
            TRY(path_format(&path, "%s%s", prefix, file.text));
            TRY(each(user, path.text));
        }
done:
    return st;
}

status farm_task_done(const struct farm *f, const struct farm_task *t, bool *done)
{
    status st = OK;
    const struct farm_kind_info *kind = &farm_kinds[t->kind];
    const struct job *job = farm_job(f, t);
    struct path root;
    *done = true;
    switch (kind->cut) {
    case CUT_BLOCKS:
        TRY(farm_root(f, t->wedge, &root));
        return sim_done(root.text, job, t->frames, done);
    case CUT_VIEWS:
        return views_done(f, t, done);
    case CUT_ALL_WEDGES:
        return across_done(f, t, done);
    case CUT_JOB:
        return farm_ended(f, done);
    case CUT_CHUNKS:
    case CUT_LIST:
    case CUT_ONCE:
    case CUT_LAST:
        for (int frame = t->frames.first; frame <= t->frames.last && *done; frame += t->frames.step)
            if (!kind->takes || kind->takes(job, frame))
                TRY(frame_done(f, t, frame, done));
    }
done:
    return st;
}
