#include "run/owner.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/log.h"
#include "checkpoint/checkpoint.h"
#include "output/product.h"
#include "run/branch.h"

/* *frame: the first that differs. A last frame may have files that it would not have as one of many (output.vdb.every); it is then made
 * again. */
static status first_changed(const struct job *theirs, const struct job *job, const struct job_states *ours,
                            int *frame)
{
    status st = OK;
    struct job_states states = {0};
    const int last = theirs->frames.last;
    TRY(job_states(theirs, &states));
    *frame = job_states_differ(&states, ours);
    for (int kind = JOB_VOLUMES; kind <= JOB_PICTURES && *frame > last && job->frames.last > last; kind++)
        if (!job_writes(job, (enum job_files)kind, last))
            *frame = last;
done:
    job_states_free(&states);
    return st;
}

status owner_refuse(const char *root, const char *path, const struct job *theirs, const struct job *ours)
{
    status st = OK;
    char key[256], kept[48];
    struct job_states states = {0};
    int frame;
    if (strcmp(theirs->name, ours->name) != 0)
        return fail(E_CHECKPOINT, "%s holds another job, %s; use another --out", root, theirs->name);
    TRY(job_differ(theirs, ours, false, key));
    if (strcmp(key, "frames") == 0) {
        st = fail(
            E_CHECKPOINT,
            "%s holds this job's frames from frame %d on, but the job now begins at frame %d, which changes the age of the rock in every frame; use another --out, or start over with hoodoo run --resume never",
            root, theirs->frames.first, ours->frames.first);
        goto done;
    }
    TRY(job_states(ours, &states));
    frame = states.first;
    if (theirs->frames.first == states.first)
        TRY(first_changed(theirs, ours, &states, &frame));
    if (frame > states.first)
        st = fail(
            E_CHECKPOINT,
            "%s holds another job: %s differs in %s, which changes the simulation from frame %d on; add --continue to keep frames %s, use another --out, or start over with hoodoo run --resume never",
            root, path, key, frame, range_text((struct frame_range){states.first, frame - 1, 1}, kept));
    else
        st = fail(
            E_CHECKPOINT,
            "%s holds another job: %s differs in %s, which changes the simulation from its first frame on; use another --out, or start over with hoodoo run --resume never",
            root, path, key);
done:
    job_states_free(&states);
    return st;
}

status owner_refuse_mixed(const char *root, struct frame_range frames, const char *key)
{
    char range[48];
    return fail(
        E_CHECKPOINT,
        "%s: frames %s were written with another %s than the job has now, and all frames of a folder must be written alike; restore the old value, use another --out, or start over with hoodoo run --resume never (hoodoo aov makes pictures with other cameras from existing frames)",
        root, range_text(frames, range), key);
}

status owner_check_files(const char *root, const struct job *theirs, const struct job *ours)
{
    status st = OK;
    uint64_t hash, other;
    int *frames = NULL;
    size_t n = 0;
    char key[256];
    TRY(job_files_hash(theirs, &hash));
    TRY(job_files_hash(ours, &other));
    TRY(folder_frames(root, ours->name, &frames, &n));
    if (n == 0 || hash == other)
        goto done;
    TRY(job_differ(theirs, ours, true, key));
    st = owner_refuse_mixed(root, (struct frame_range){frames[0], frames[n - 1], 1}, key);
done:
    free(frames);
    return st;
}

/* ---- frames of other jobs */

status owner_states(const char *root, struct job_states *out, bool *edited, char why[600])
{
    status st = OK;
    struct path path;
    struct job *job = NULL;
    uint64_t made;
    *out = (struct job_states){0};
    *edited = false;
    why[0] = '\0';
    TRY(folder_job_hash(root, &made));
    TRY(path_join(&path, root, "job.yaml"));
    TRY(job_load(path.text, NULL, 0, &job));
    st = branch_prepare_own(job, root);
    if (st == OK)
        st = job_states(job, out);
    if (st == E_INPUT) {
        snprintf(why, 600, "%.180s cannot be compared with the job of the frames: %.350s", path.text,
                 status_message());
        job_states_free(out);
        st = OK;
    } else if (st == OK && out->job != made) {
        snprintf(why, 600, "%.500s is not the job of the frames", path.text);
        *edited = true;
        job_states_free(out);
    }
done:
    job_destroy(&job);
    return st;
}

status owner_check_frames(const char *root, const char *name, struct frame_range frames,
                          struct job_states *out)
{
    status st = OK;
    int *there = NULL;
    size_t n = 0;
    bool edited;
    char why[600];
    TRY(owner_states(root, out, &edited, why));
    if (edited)
        log_warn("%s; the next hoodoo run rewrites it", why);
    if (out->n)
        TRY(folder_frames(root, name, &there, &n));
    for (size_t i = 0; i < n; i++) {
        struct manifest m = {0};
        if (frames.step && !range_holds(frames, there[i]))
            continue;
        st = manifest_read(root, name, there[i], &m);
        if (st == OK && !job_states_hold(out, there[i], m.job_hash))
            st = fail(E_INPUT, "%s: frame %d belongs to another job; hoodoo run makes it again", root,
                      there[i]);
        else if (st == E_INPUT)
            st = OK; /* `verify` and `run` report damage */
        manifest_free(&m);
        TRY(st);
    }
done:
    free(there);
    return st;
}

/* ---- taking over */

/* Counts the products of frames from `first` on, and of all frames. */
static status count_products(const char *root, int first, size_t *of_frames, size_t *of_all)
{
    status st = OK;
    struct product_list list = {0};
    TRY(product_list(root, &list));
    *of_frames = *of_all = 0;
    for (size_t i = 0; i < list.n; i++) {
        struct product p = {0};
        if (strcmp(list.path[i], "job.yaml") == 0 || strcmp(list.path[i], "run.json") == 0)
            continue;
        st = product_read(root, list.path[i], &p);
        *of_frames += st == OK && p.frame != ALL_FRAMES && p.frame >= first;
        *of_all += st == OK && p.frame == ALL_FRAMES;
        product_free(&p);
        if (st == E_MEMORY)
            goto done;
        st = OK;
    }
done:
    product_list_free(&list);
    return st;
}

static status say(const char *root, const char *name, int begin, int first, const char *key)
{
    status st = OK;
    int *frames = NULL;
    size_t n = 0, old = 0, of_frames, of_all;
    char kept[48], gone[48];
    TRY(folder_frames(root, name, &frames, &n));
    while (old < n && frames[old] < first)
        old++;
    range_text((struct frame_range){begin, first - 1, 1}, kept);
    if (old == n) {
        log_info("--continue: %s differs, which changes no frame that %s has; all are kept", key, root);
        goto done;
    }
    range_text((struct frame_range){frames[old], frames[n - 1], 1}, gone);
    log_info(
        "--continue: %s differs from frame %d on: frames %s are kept; frames %s are removed and made again",
        key, first, kept, gone);
    TRY(count_products(root, first, &of_frames, &of_all));
    if (of_frames + of_all)
        log_info(
            "--continue: %zu files made from these frames and %zu made from all frames, such as the stage, become out of date; hoodoo verify %s names the commands that make them again",
            of_frames, of_all, root);
done:
    free(frames);
    return st;
}

status owner_change(const char *root, const char *path, const struct job *theirs, const struct job *job,
                    const struct job_states *ours, struct change *out)
{
    status st = OK;
    char key[256];
    struct change c = {.any = true};
    TRY(job_hash(theirs, &c.job_hash));
    if (strcmp(theirs->name, job->name) != 0 || theirs->frames.first != job->frames.first)
        return owner_refuse(root, path, theirs, job);
    TRY(first_changed(theirs, job, ours, &c.frame));
    if (c.frame <= ours->first)
        return owner_refuse(root, path, theirs, job);
    TRY(owner_check_files(root, theirs, job));
    c.any = c.job_hash != ours->job || c.frame <= theirs->frames.last; /* else only frames are added */
    TRY(job_differ(theirs, job, false, key));
    TRY(say(root, job->name, ours->first, c.frame, key));
    *out = c;
done:
    return st;
}

static status discard_frame(const char *root, const char *name, int frame)
{
    status st = OK;
    struct manifest m = {0};
    struct path path;
    st = manifest_read(root, name, frame, &m);
    if (st == E_INPUT)
        st = OK; /* its files are unknown, and are replaced later */
    TRY(st);
    TRY(folder_path(&path, root, name, FILE_MANIFEST, frame, NULL));
    unlink(path.text);
    for (size_t i = 0; i < m.n_files; i++) {
        TRY(path_join(&path, root, m.file[i].path));
        unlink(path.text);
    }
done:
    manifest_free(&m);
    return st;
}

status owner_discard(const char *root, const char *name, int first)
{
    static const enum folder_file kinds[] = {FILE_CHECKPOINT, FILE_KEEP};
    status st = OK;
    int *frames = NULL;
    size_t n = 0;
    struct path path;
    for (size_t k = 0; k < sizeof kinds / sizeof *kinds; k++) {
        TRY(folder_list(root, name, kinds[k], &frames, &n));
        for (size_t i = 0; i < n; i++)
            if (frames[i] >= first) {
                TRY(folder_path(&path, root, name, kinds[k], frames[i], NULL));
                unlink(path.text);
            }
        free(frames);
        frames = NULL;
    }
    TRY(folder_frames(root, name, &frames, &n));
    for (size_t i = n; i-- > 0 && frames[i] >= first;)
        TRY(discard_frame(root, name, frames[i]));
done:
    free(frames);
    return st;
}
