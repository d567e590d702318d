#include "run/run.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/clock.h"
#include "base/log.h"
#include "base/memory.h"
#include "base/visible.h"
#include "frame/stage.h"
#include "model/model.h"
#include "output/product.h"
#include "run/advice.h"
#include "run/branch.h"
#include "run/memory.h"
#include "run/owner.h"
#include "run/provenance.h"
#include "run/timing.h"
#include "run/writer.h"
#include "system/atomic_file.h"
#include "system/lock.h"

struct run {
    const struct job *job;
    const struct run_options *options;
    struct job_states states;
    struct change change; /* the folder's job before, with --continue */
    struct frame_range frames;
    struct gpu *gpu;
    struct model *model;
    struct writer *writer;
    struct lock *lock;
    struct provenance provenance;
    struct path lock_path;
    bool lacks_checkpoint; /* there is no checkpoint of the last frame or a later one */
    bool no_checkpoint;    /* there is none at all */
    bool *done;            /* [last - first + 1], by frame number */
    bool *compared;        /* likewise: the files were read and have the content that was written */
    bool write_provenance; /* run.json or job.yaml is missing or does not describe this job */
    uint64_t files_hash;
    struct frame_range other; /* frames whose files were written with other settings; step 0: none */
    int first_missing;        /* last + 1: none is missing */
    int last_missing;
    size_t n_done;
    bool any_frames; /* the folder has frames, requested or not */
    int start_frame; /* the frame at which the model was created or restored */
    enum frame_pace pace;
};

/* ---- what the folder has */

/* A frame is done when `verify` would find nothing wrong with it. The content of its files is compared once per run; later calls
 * compare only their sizes. */
static status frame_done(struct run *r, int frame, bool *done, bool *compared)
{
    struct manifest manifest = {0};
    const char *bad = "";
    status st = manifest_read(r->options->root, r->job->name, frame, &manifest);
    if (st == OK)
        st = manifest_check(r->options->root, &manifest, !*compared, &bad);
    *done = st == OK && *bad == '\0' && job_states_hold(&r->states, frame, manifest.job_hash);
    *compared = *done;
    if (st == OK && *bad)
        log_info("frame %d will be made again: %s", frame, status_message());
    else if (st == OK && !*done)
        log_info("frame %d will be made again: it belongs to another job", frame);
    else if (*done && manifest.files_hash != r->files_hash)
        r->other = (struct frame_range){r->other.step ? r->other.first : frame, frame, 1};
    manifest_free(&manifest);
    return st == E_MEMORY ? st : OK; /* a missing or damaged manifest is not an error here */
}

/* Checkpoints of marked frames: existing ones are marked to be kept, missing ones extend the range of missing frames. */
static status survey_marks(struct run *r, const int *existing, size_t n)
{
    status st = OK;
    for (int f = r->frames.first; f <= r->frames.last && r->job->checkpoint.n_mark; f++) {
        bool found = false;
        if (!job_marks(r->job, f))
            continue;
        for (size_t i = 0; i < n; i++)
            found |= existing[i] == f;
        if (found) {
            TRY(checkpoint_mark(r->options->root, r->job->name, f));
            continue;
        }
        if (r->first_missing > r->frames.last)
            r->last_missing = f;
        r->first_missing = f < r->first_missing ? f : r->first_missing;
        r->last_missing = f > r->last_missing ? f : r->last_missing;
    }
done:
    return st;
}

static status survey(struct run *r)
{
    status st = OK;
    size_t n = (size_t)(r->frames.last - r->frames.first) + 1;
    int *existing = NULL, *checkpoints = NULL;
    size_t n_existing, n_checkpoints;
    free(r->done);
    r->done = NULL;
    r->n_done = 0;
    TRY(memory_alloc(n, sizeof *r->done, "the frames", &r->done));
    if (!r->compared)
        TRY(memory_alloc(n, sizeof *r->compared, "the frames", &r->compared));
    TRY(folder_frames(r->options->root, r->job->name, &existing, &n_existing));
    r->any_frames = n_existing > 0;
    for (size_t i = 0; i < n_existing; i++) {
        if (!range_holds(r->frames, existing[i]) || (r->change.any && existing[i] >= r->change.frame))
            continue;
        if (r->options->stop && r->options->stop()) {
            st = fail(STOPPED,
                      "stopped while checking the existing frames; run the same command again to continue");
            goto done;
        }
        const int at = existing[i] - r->frames.first;
        TRY(frame_done(r, existing[i], &r->done[at], &r->compared[at]));
    }
    r->first_missing = r->frames.last + 1;
    for (int f = r->frames.last; f >= r->frames.first; f--)
        if (range_holds(r->frames, f)) {
            r->n_done += r->done[f - r->frames.first];
            if (r->done[f - r->frames.first])
                continue;
            if (r->first_missing > r->frames.last)
                r->last_missing = f;
            r->first_missing = f;
        }
    /* The next block of frames starts from the last frame's checkpoint, so a run without it is not complete. */
    TRY(checkpoint_list(r->options->root, r->job->name, &checkpoints, &n_checkpoints));
    r->no_checkpoint = n_checkpoints == 0;
    r->lacks_checkpoint = r->no_checkpoint || checkpoints[0] < r->frames.last;
    if (r->lacks_checkpoint)
        r->last_missing = r->frames.last;
    TRY(survey_marks(r, checkpoints, n_checkpoints));
done:
    free(existing);
    free(checkpoints);
    return st;
}

/* Whether run.json says that the folder's frames belong to this job. */
static bool frames_are_ours(const struct run *r)
{
    uint64_t hash;
    return folder_job_hash(r->options->root, &hash) == OK && hash == r->states.job;
}

/* Decides whether job.yaml must be rewritten because keys were edited that no frame depends on, such as those of previews: the other
 * verbs read them from there. Running fewer frames than the folder has is not an edit. */
static status compare_job_file(struct run *r, struct job *theirs)
{
    status st = OK;
    struct text old = {0}, new = {0};
    if (range_holds(theirs->frames, r->job->frames.first) && range_holds(theirs->frames, r->job->frames.last))
        theirs->frames = r->job->frames;
    TRY(job_resolved(theirs, &old));
    TRY(job_resolved(r->job, &new));
    r->write_provenance = old.size != new.size || memcmp(old.data, new.data, new.size) != 0;
done:
    text_free(&old);
    text_free(&new);
    return st;
}

/* Checks that the folder's job.yaml, which is the job as it was run, is this job. */
static status check_owner(struct run *r)
{
    status st = OK;
    struct path path;
    struct job *theirs = NULL;
    uint64_t hash;
    TRY(path_join(&path, r->options->root, "job.yaml"));
    r->write_provenance = access(path.text, F_OK) != 0;
    if (r->write_provenance)
        return OK;
    st = job_load(path.text, NULL, 0, &theirs);
    if (st == OK)
        st = branch_prepare_own(theirs, r->options->root);
    if (st == OK)
        st = job_hash(theirs, &hash);
    if (st == E_MEMORY)
        goto done;
    if (st != OK && frames_are_ours(r)) {
        log_warn("%s; it is rewritten, because the frames are this job's", status_message());
        r->write_provenance = true;
        st = OK;
    } else if (st != OK) {
        st = fail(
            E_CHECKPOINT,
            "%s cannot be read, so it is not known which job this folder belongs to (%s); use another --out, or --resume never to start over",
            path.text, status_message());
    } else if (strcmp(theirs->name, r->job->name) == 0 && hash != r->states.job && frames_are_ours(r)) {
        log_warn("%s is not the job that made the frames; it is rewritten", path.text);
        r->write_provenance = true;
    } else if (r->options->change && (hash != r->states.job || theirs->frames.last < r->job->frames.last)) {
        TRY(owner_change(r->options->root, path.text, theirs, r->job, &r->states, &r->change));
        r->write_provenance = true;
    } else if (hash != r->states.job || strcmp(theirs->name, r->job->name) != 0) {
        st = owner_refuse(r->options->root, path.text, theirs, r->job);
    } else {
        TRY(owner_check_files(r->options->root, theirs, r->job));
        TRY(compare_job_file(r, theirs));
    }
done:
    job_destroy(&theirs);
    return st;
}

/* --resume never: deletes the job's checkpoints, records and manifests, so that nothing counts as done. */
static status discard_frames(const struct run *r)
{
    status st = OK;
    int *frames = NULL;
    size_t n;
    struct path path;
    TRY(checkpoint_list(r->options->root, r->job->name, &frames, &n));
    for (size_t i = 0; i < n; i++) {
        TRY(folder_path(&path, r->options->root, r->job->name, FILE_CHECKPOINT, frames[i], NULL));
        unlink(path.text);
    }
    TRY(product_remove_records(r->options->root));
    free(frames);
    frames = NULL;
    TRY(folder_frames(r->options->root, r->job->name, &frames, &n));
    for (size_t i = 0; i < n; i++) {
        TRY(folder_path(&path, r->options->root, r->job->name, FILE_MANIFEST, frames[i], NULL));
        unlink(path.text);
    }
done:
    free(frames);
    return st;
}

/* --repair deletes damaged checkpoints; the frames they cover are simulated again. */
static status remove_damaged_checkpoints(const struct run *r)
{
    status st = OK;
    int *frames = NULL;
    size_t n;
    struct path path;
    struct checkpoint c;
    TRY(checkpoint_list(r->options->root, r->job->name, &frames, &n));
    for (size_t i = 0; i < n; i++) {
        TRY(folder_path(&path, r->options->root, r->job->name, FILE_CHECKPOINT, frames[i], NULL));
        st = checkpoint_read_index(path.text, &c);
        if (st == E_CHECKPOINT) {
            log_warn("%s; the checkpoint is removed", status_message());
            unlink(path.text);
            st = OK;
        }
        TRY(st);
    }
done:
    free(frames);
    return st;
}

static status check_lock(void *lock)
{
    return lock_check(lock);
}

/* Takes the folder's lock, without which nothing is renamed into place from now on. Another process may have written frames before that, so the folder is surveyed again. */
static status lock_folder(struct run *r)
{
    status st = OK;
    char what[128], frames[48];
    snprintf(what, sizeof what, "simulates frames %s here", range_text(r->frames, frames));
    TRY(lock_take(r->lock_path.text, what, (struct lock_patience){0}, r->options->stop, &r->lock));
    atomic_file_guard(check_lock, r->lock);
    if (r->options->resume == RUN_NEVER)
        TRY(discard_frames(r));
    if (r->options->repair)
        TRY(remove_damaged_checkpoints(r));
    TRY(survey(r));
done:
    return st;
}

/* ---- checkpoints */

/* Checks that this process may continue the checkpoint: bit for bit, unless --resume allows otherwise. */
static status check_provenance(struct run *r, const struct checkpoint *c, const char *path)
{
    return provenance_continue(&r->provenance, &c->maker, c->frame, path);
}

/* Reads the newest sound checkpoint at or before the first missing frame; *found is false if there is none. Damaged ones are
 * reported and skipped. */
static status find_checkpoint(struct run *r, struct checkpoint *c, bool *found)
{
    status st = OK;
    int *frames = NULL;
    size_t n;
    struct path path;
    *found = false;
    TRY(checkpoint_list(r->options->root, r->job->name, &frames, &n));
    for (size_t i = 0; i < n && !*found; i++) {
        if (frames[i] > r->first_missing)
            continue;
        TRY(folder_path(&path, r->options->root, r->job->name, FILE_CHECKPOINT, frames[i], NULL));
        st = checkpoint_read(path.text, c);
        if (st == E_CHECKPOINT) {
            log_warn("%s; trying the one before", status_message());
            st = OK;
            continue;
        }
        TRY(st);
        if (!job_states_hold(&r->states, c->frame, c->job_hash)) {
            log_info("%s is not of this job; trying the one before", path.text);
            checkpoint_free(c);
            continue;
        }
        TRY(check_provenance(r, c, path.text));
        *found = true;
    }
done:
    free(frames);
    return st;
}

static status save(struct run *r)
{
    status st = OK;
    struct checkpoint c;
    TRY(model_save(r->model, &c));
    c.job_hash = job_state(&r->states, c.frame);
    c.maker = r->provenance.here;
    TRY(writer_checkpoint(r->writer, &c));
done:
    return st;
}

/* ---- the loop */

static status check_memory(struct run *r)
{
    const struct gpu_info *info = gpu_info(r->gpu);
    struct model_estimate e;
    status st = run_memory_check(r->gpu, r->job, &e);
    if (st != OK)
        return st;
    log_info("about %zu particles, %.2f GB on %s (%s)", e.n_particles, (double)e.device_bytes / 1e9,
             info->name, info->driver);
    r->pace = run_memory_pace(r->gpu, &e);
    if (r->pace == PACE_ALTERNATE)
        log_info("memory holds one frame at a time: each is written before the next is made");
    if (r->pace == PACE_STREAM)
        log_info("frames are streamed: volumes are read from the device grid by grid while they are written");
    return OK;
}

/* The same for a block that cannot start without one: a shared disk may not show it yet. */
static status await_checkpoint(struct run *r, struct checkpoint *c, bool *found)
{
    status st = OK;
    const bool needed = r->frames.first != r->job->frames.first && !r->options->repair;
    const double until = clock_seconds() + visible_delay();
    for (bool said = false;; said = true) {
        TRY(find_checkpoint(r, c, found));
        if (*found || !needed || clock_seconds() >= until || (r->options->stop && r->options->stop()))
            break;
        if (!said)
            log_info("%s has no checkpoint before frame %d yet; looking again for %.0f s", r->options->root,
                     r->first_missing, visible_delay());
        usleep(500000);
    }
done:
    return st;
}

static status begin(struct run *r)
{
    status st = OK;
    struct checkpoint c = {0};
    bool found;
    TRY(provenance_begin(r->gpu, r->options->root, r->options->resume, &r->provenance));
    TRY(await_checkpoint(r, &c, &found));
    if (!found && r->any_frames)
        TRY(provenance_restart(&r->provenance, r->job->frames.first, r->options->root));
    if (!found && r->options->resume == RUN_REQUIRE) {
        st = fail(E_CHECKPOINT,
                  "%s has no usable checkpoint at or before frame %d, and --resume require was given",
                  r->options->root, r->first_missing);
        goto done;
    }
    if (!found && r->frames.first != r->job->frames.first && !r->options->repair) {
        st = fail(
            E_CHECKPOINT,
            "%s has no usable checkpoint before frame %d; frames are simulated in order, so run the preceding block of frames first",
            r->options->root, r->first_missing);
        goto done;
    }
    if (!found && *r->job->from) {
        struct branch_state branch;
        TRY(branch_read(r->job, r->options->root, &branch));
        c = branch.at;
        r->provenance.from_m = branch.spacing_m;
        TRY(check_provenance(r, &c, r->job->from));
        found = true;
        log_info("branching from %s, frame %d, %.10g years", r->job->from, c.frame, c.years);
    } else if (found)
        log_info("continuing from the checkpoint of frame %d; %zu of %zu frames are done", c.frame, r->n_done,
                 range_count(r->frames));
    TRY(model_create(r->gpu, r->job, found ? &c : NULL, &r->model));
    r->start_frame = model_frame(r->model);
    model_on_stage(r->model, r->options->stage, r->options->user);
    if (r->pace == PACE_STREAM)
        model_stream(r->model);
    /* Only now, so that a job whose scene is refused does not claim the folder. */
    TRY(provenance_change(&r->provenance, &r->change));
    TRY(provenance_write(&r->provenance, r->gpu, r->job, r->states.job, r->options->root));
    if (r->change.any)
        TRY(owner_discard(r->options->root, r->job->name, r->change.frame));
    TRY(writer_create(r->job, &r->states, r->options->root, r->pace != PACE_OVERLAP, &r->writer));
done:
    checkpoint_free(&c);
    return st;
}

static status finish_frame(struct run *r)
{
    status st = OK;
    struct frame frame;
    int number = model_frame(r->model);
    if (number < r->frames.first || !range_holds(r->frames, number) || r->done[number - r->frames.first])
        return OK;
    TRY(model_output(r->model, &frame));
    double share = frame.start_volume_m3 > 0 ? frame.volume_m3 / frame.start_volume_m3 : 0;
    int iterations = frame.stress_iterations;
    TRY(writer_frame(r->writer, &frame));
    if (r->options->frame)
        r->options->frame(r->options->user, number, share, iterations);
done:
    return st;
}

static status simulate(struct run *r)
{
    status st = OK;
    int last = r->last_missing;
    char range[48];
    /* If true, all later frames are done and have their checkpoints. */
    bool repair = last < r->frames.last;
    /* Whether this process made the current state, or its frame's files are missing; otherwise its files are there already. */
    bool fresh = model_frame(r->model) == r->job->frames.first || model_frame(r->model) == r->first_missing;
    for (;;) {
        int number = model_frame(r->model);
        TRY(lock_check(r->lock));
        /* Save the checkpoint before the last frame: the last frame's manifest marks the block of frames as complete, and the next
         * block starts from this checkpoint. */
        if (fresh && number >= last && !repair)
            TRY(save(r));
        if (fresh)
            TRY(finish_frame(r));
        bool marked = job_marks(r->job, number);
        if (number >= last) {
            if (fresh && repair && marked)
                TRY(save(r));
            break;
        }
        bool stop = r->options->stop && r->options->stop();
        bool due = (number - r->job->frames.first) % (int)r->job->checkpoint.every == 0;
        if (fresh && ((due && !repair) || marked || stop))
            TRY(save(r));
        if (stop) {
            TRY(writer_finish(&r->writer));
            st = fail(
                STOPPED,
                "stopped after frame %d, with its checkpoint saved; run the same command again to continue",
                number);
            goto done;
        }
        TRY(model_step(r->model));
        fresh = true;
    }
    TRY(writer_finish(&r->writer));
    log_info("frames %s are in %s; other programs can open them with %s/%s.usda",
             range_text(r->frames, range), r->options->root, r->options->root, r->job->name);
done:
    return st;
}

/* All frames are done: restores run.json, job.yaml and the USD stage where necessary. The stage is made from the folder's own
 * job.yaml, because the files are as that job wrote them. */
static status complete_folder(struct run *r)
{
    status st = OK;
    struct path path;
    struct job *theirs = NULL;
    bool intact;
    TRY(provenance_intact(r->options->root, &intact));
    if (r->write_provenance || !intact || !frames_are_ours(r)) {
        if (!r->lock)
            TRY(lock_folder(r));
        TRY(provenance_restore(r->job, r->states.job, &r->change, r->options->root));
    }
    if (r->change.any)
        TRY(owner_discard(r->options->root, r->job->name, r->change.frame));
    TRY(path_join(&path, r->options->root, "job.yaml"));
    TRY(job_load(path.text, NULL, 0, &theirs));
    TRY(stage_write(theirs, &r->states, r->options->root, NULL));
done:
    job_destroy(&theirs);
    return st;
}

status run_take_over(const struct job *job, const char *root, bool change)
{
    status st = OK;
    const struct run_options options = {.root = root, .change = true};
    struct run r = {.job = job, .options = &options, .frames = job->frames};
    const bool hushed = log_silence(change); /* it has been said */
    TRY(job_states(job, &r.states));
    TRY(job_files_hash(job, &r.files_hash));
    TRY(path_join(&r.lock_path, root, "lock"));
    TRY(check_owner(&r));
    log_silence(hushed);
    if (!change || !r.change.any)
        goto done;
    TRY(lock_folder(&r));
    TRY(provenance_restore(job, r.states.job, &r.change, root));
    TRY(owner_discard(root, job->name, r.change.frame));
done:
    log_silence(hushed);
    atomic_file_guard(NULL, NULL);
    lock_release(&r.lock);
    job_states_free(&r.states);
    free(r.done);
    free(r.compared);
    return st;
}

/* Whether frames behind the requested ones are still to be made, for which a checkpoint is needed. */
static bool frames_follow(const struct run *r)
{
    struct path path;
    bool all = true;
    for (int f = r->frames.last + r->job->frames.step; f <= r->job->frames.last && all;
         f += r->job->frames.step)
        all = folder_path(&path, r->options->root, r->job->name, FILE_MANIFEST, f, NULL) == OK &&
              access(path.text, F_OK) == 0;
    return !all;
}

status run_job(struct job *job, const struct run_options *options)
{
    status st = OK;
    const double started = clock_seconds();
    char message[2048];
    struct run r = {.job = job, .options = options, .frames = options->frames};
    TRY(branch_prepare(job, options->root));
    if (r.frames.step == 0)
        r.frames = job->frames;
    if (!range_holds(job->frames, r.frames.first) || !range_holds(job->frames, r.frames.last)) {
        char requested[48], all[48];
        return fail(E_USAGE, "--frames %s: the job's frames are %s", range_text(r.frames, requested),
                    range_text(job->frames, all));
    }
    TRY(job_states(job, &r.states));
    TRY(job_files_hash(job, &r.files_hash));
    TRY(folder_prepare(options->root));
    TRY(path_join(&r.lock_path, options->root, "lock"));
    if (options->resume != RUN_NEVER)
        TRY(check_owner(&r));
    if (!options->repair)
        TRY(survey(&r));
    if (options->resume != RUN_NEVER && r.other.step)
        TRY(owner_refuse_mixed(options->root, r.other, "setting of output, cameras, fps or colours"));
    const bool needed = r.no_checkpoint && frames_follow(&r);
    if (options->repair || options->resume == RUN_NEVER || r.first_missing <= r.frames.last || needed)
        TRY(lock_folder(&r));
    else
        lock_sweep(r.lock_path.text);
    if (r.n_done == 0 && r.frames.first == job->frames.first && !*job->from)
        TRY(advice_log(job, true));
    if (options->begin)
        options->begin(options->user, r.frames, r.n_done);
    if (r.first_missing > r.frames.last && !needed && !(options->repair && r.lacks_checkpoint)) {
        log_info("all %zu frames are done already", r.n_done);
        st = complete_folder(&r);
        goto done;
    }
    TRY(gpu_create(&(struct gpu_options){.device = options->device}, &r.gpu));
    TRY(check_memory(&r));
    TRY(begin(&r));
    TRY(simulate(&r));
done:
    snprintf(message, sizeof message, "%s", status_message());
    if (r.model)
        timing_write(options->root, r.gpu, r.start_frame, model_frame(r.model), started);
    if (st != OK) {
        /* What was queued before the failure is sound, so it is still written. The first error is the one returned. */
        if (writer_finish(&r.writer) != OK && strcmp(status_message(), message) != 0)
            log_warn("%s", status_message());
        fail(st, "%s", message);
    }
    model_destroy(&r.model);
    gpu_destroy(&r.gpu);
    atomic_file_guard(NULL, NULL);
    lock_release(&r.lock);
    provenance_free(&r.provenance);
    job_states_free(&r.states);
    free(r.done);
    free(r.compared);
    return st;
}
