#include "run/writer.h"

#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>

#include "base/clock.h"
#include "base/hash.h"
#include "base/memory.h"
#include "exr/exr.h"
#include "frame/stage.h"
#include "job/palette.h"
#include "output/folder.h"
#include "run/timing.h"
#include "system/atomic_file.h"
#include "usd/usd.h"
#include "vdb/vdb.h"

/* ---- the files of one frame */

static uint64_t identity(uint64_t state, int frame, enum folder_file kind)
{
    uint64_t words[3] = {state, (uint64_t)(int64_t)frame, (uint64_t)kind};
    return hash_bytes(words, sizeof words);
}

/* Begins a frame's file, whose folder is made when it is first needed. If root is "", the file is only made in memory. */
static status begin_file(const char *root, const char *name, enum folder_file kind, int frame,
                         const char *camera, struct draft *file)
{
    status st = OK;
    struct path path, folder;
    *file = (struct draft){0};
    if (!*root)
        return OK;
    TRY(folder_path(&path, root, name, kind, frame, camera));
    TRY(path_folder(&folder, path.text));
    TRY(folder_make(folder.text));
    TRY(atomic_file_begin(path.text, file));
done:
    return st;
}

/* Adds the file to the manifest and moves it into place. Drops the draft, also on error. */
static status end_file(const char *root, struct draft *file, struct manifest *manifest)
{
    status st = OK;
    size_t capacity = manifest->n_files;
    uint64_t hash;
    TRY(draft_hash(file, 0, file->size, &hash));
    if (!*root)
        goto done;
    TRY(memory_grow(&manifest->file, &capacity, manifest->n_files + 1, sizeof *manifest->file,
                    "the manifest"));
    struct manifest_file *entry = &manifest->file[manifest->n_files++];
    *entry = (struct manifest_file){.size = file->size, .hash = hash};
    snprintf(entry->path, sizeof entry->path, "%s", file->path.text + strlen(root) + 1);
    TRY(atomic_file_finish(file));
done:
    draft_drop(file);
    return st;
}

static status write_points(const struct job *job, uint64_t state, const char *root, const struct frame *frame,
                           struct vdb_options *options, struct manifest *manifest)
{
    status st = OK;
    struct draft file = {0};
    if (options->points != VDB_POINTS_NONE) {
        options->identity = identity(state, frame->number, FILE_POINTS);
        TRY(begin_file(root, job->name, FILE_POINTS, frame->number, NULL, &file));
        TRY(vdb_points_of_frame(&frame->rock, frame->deep.voxels[0] ? &frame->deep : NULL, options, &file));
        TRY(end_file(root, &file, manifest));
    }
    if (job->output.usd.points != USD_POINTS_NONE) {
        TRY(begin_file(root, job->name, FILE_USD, frame->number, NULL, &file));
        TRY(usd_points(&frame->rock, options, job->fps, &file));
        TRY(end_file(root, &file, manifest));
    }
done:
    draft_drop(&file);
    return st;
}

static status write_vdbs(const struct job *job, uint64_t state, const char *root, const struct frame *frame,
                         struct manifest *manifest)
{
    status st = OK;
    struct draft file = {0};
    size_t n_layers = palette_size(job);
    float(*color)[3] = NULL;
    struct vdb_options options = {
        .up = job->output.up,
        .codec = job->output.vdb.codec,
        .half = job->output.vdb.half,
        .points = job->output.vdb.points,
        .precision = job->output.vdb.precision,
        .moves = job->clock.seconds_per_frame > 0,
        .frame = frame->number,
        .spacing = job->domain.spacing_m,
        .n_colors = n_layers,
    };
    TRY(memory_alloc(n_layers, sizeof *color, "colours", &color));
    for (size_t i = 0; i < n_layers; i++)
        palette_color(job, i, color[i]);
    options.color = (const float(*)[3])color;
    if (job_writes(job, JOB_POINTS, frame->number))
        TRY(write_points(job, state, root, frame, &options, manifest));
    if (!job_writes(job, JOB_VOLUMES, frame->number))
        goto done;
    options.identity = identity(state, frame->number, FILE_VOLUMES);
    TRY(begin_file(root, job->name, FILE_VOLUMES, frame->number, NULL, &file));
    TRY(vdb_volumes(&frame->grids, &options, &file));
    TRY(end_file(root, &file, manifest));
    if (frame->air.n_grids && job->output.vdb.wind) {
        options.identity = identity(state, frame->number, FILE_WIND);
        TRY(begin_file(root, job->name, FILE_WIND, frame->number, NULL, &file));
        TRY(vdb_volumes(&frame->air, &options, &file));
        TRY(end_file(root, &file, manifest));
    }
    if (frame->rocks.wanted) {
        options.identity = identity(state, frame->number, FILE_ROCKS);
        options.instances = true;
        options.points = VDB_POINTS_ALL;
        options.precision = VDB_PRECISION_EXACT;
        options.spacing = job_piles(job)->rock_m;
        TRY(begin_file(root, job->name, FILE_ROCKS, frame->number, NULL, &file));
        TRY(vdb_points(&frame->rocks.at, &options, &file));
        TRY(end_file(root, &file, manifest));
        TRY(begin_file(root, job->name, FILE_ROCKS_USD, frame->number, NULL, &file));
        TRY(usd_rocks(&frame->rocks, &options, job->fps, &file));
        TRY(end_file(root, &file, manifest));
    }
done:
    draft_drop(&file);
    free(color);
    return st;
}

static status write_images(const struct job *job, uint64_t state, const char *root, const struct frame *frame,
                           struct manifest *manifest)
{
    status st = OK;
    struct draft file = {0};
    void *bytes = NULL;
    size_t size;
    struct exr_options options = {.layout = job->output.aov.layout,
                                  .fps = job->fps,
                                  .frame = frame->number,
                                  .years = frame->years,
                                  .job_hash = state,
                                  .owner = job->output.owner,
                                  .comments = job->output.comments,
                                  .wedge = job->wedge.label};
    for (size_t i = 0; i < frame->n_images; i++) {
        TRY(exr_encode(&frame->image[i], &options, &bytes, &size));
        TRY(begin_file(root, job->name, FILE_AOV, frame->number,
                       frame->n_images > 1 ? frame->image[i].camera : NULL, &file));
        TRY(draft_append(&file, bytes, size));
        free(bytes);
        bytes = NULL;
        TRY(end_file(root, &file, manifest));
    }
done:
    draft_drop(&file);
    free(bytes);
    return st;
}

status frame_write(const struct job *job, const struct job_states *states, const char *root,
                   const struct frame *frame)
{
    status st = OK;
    const uint64_t hash = job_state(states, frame->number);
    struct draft file = {0};
    struct manifest manifest = {
        .frame = frame->number,
        .job_hash = hash,
        .years = frame->years,
        .volume_m3 = frame->volume_m3,
        .start_volume_m3 = frame->start_volume_m3,
        .max_stress_Pa = frame->max_stress_Pa,
        .stress_iterations = frame->stress_iterations,
        .ledger = frame->ledger,
        .n_changes = frame->n_changes,
    };
    TRY(job_files_hash(job, &manifest.files_hash));
    for (size_t i = 0; i < frame->n_changes; i++) {
        snprintf(manifest.change[i].process, sizeof manifest.change[i].process, "%s",
                 frame->change[i].process);
        manifest.change[i].m3 = frame->change[i].m3;
    }
    TRY(write_vdbs(job, hash, root, frame, &manifest));
    TRY(write_images(job, hash, root, frame, &manifest));
    const struct {
        enum folder_file kind;
        const struct frame_bytes *is;
    } more[] = {{FILE_STACKS, &frame->stacks}, {FILE_VOXELS, &frame->voxels}};
    for (size_t i = 0; i < sizeof more / sizeof *more; i++)
        if (more[i].is->bytes) {
            TRY(begin_file(root, job->name, more[i].kind, frame->number, NULL, &file));
            TRY(draft_append(&file, more[i].is->bytes, more[i].is->size));
            TRY(end_file(root, &file, &manifest));
        }
    if (*root)
        TRY(manifest_write(root, job->name, &manifest));
done:
    draft_drop(&file);
    manifest_free(&manifest);
    return st;
}

/* ---- the thread */

/* One item, so that at most two frames are in memory, the one being written and the one being made: frames are the largest part of
 * a run's host memory. */
enum { QUEUE = 1, WRITER_NICE = 19 };

struct item {
    bool is_checkpoint;
    struct frame frame;
    struct checkpoint checkpoint;
};

struct writer {
    const struct job *job;
    const struct job_states *states;
    const char *root;
    bool blocking;
    pthread_t thread;
    pthread_mutex_t lock;
    pthread_cond_t changed;
    struct item *queue[QUEUE];
    int n;
    bool ending;
    status st;
    char message[2048];
    /* used by the thread only: */
    struct stage_frames frames; /* known to the USD stage */
    double last;                /* when the last frame was complete, by clock_seconds() */
};

static void item_free(struct item *item)
{
    frame_free(&item->frame);
    checkpoint_free(&item->checkpoint);
    free(item);
}

/* The mark is written first: a marked checkpoint without its mark could be pruned. */
static status write_checkpoint(const struct writer *w, const struct checkpoint *c)
{
    status st = OK;
    if (job_marks(w->job, c->frame))
        TRY(checkpoint_mark(w->root, w->job->name, c->frame));
    TRY(checkpoint_save(w->root, w->job->name, c, (int)w->job->checkpoint.keep));
done:
    return st;
}

static void *writer_main(void *argument)
{
    struct writer *w = argument;
    /* On Linux this sets the priority of this thread only. Where the device is the CPU, the simulation has precedence; it waits for the
     * writer in enqueue(). */
    if (!w->blocking)
        setpriority(PRIO_PROCESS, 0, WRITER_NICE);
    pthread_mutex_lock(&w->lock);
    while (w->n > 0 || !w->ending) {
        if (w->n == 0) {
            pthread_cond_wait(&w->changed, &w->lock);
            continue;
        }
        struct item *item = w->queue[0];
        status st = w->st;
        pthread_mutex_unlock(&w->lock);
        if (st == OK)
            st = item->is_checkpoint ? write_checkpoint(w, &item->checkpoint)
                                     : frame_write(w->job, w->states, w->root, &item->frame);
        if (st == OK && !item->is_checkpoint) {
            const double now = clock_seconds();
            timing_add_frame(w->root, item->frame.number, now - w->last);
            w->last = now;
        }
        /* Keep the USD stage current, so that an unfinished run can be opened. */
        if (st == OK && item->is_checkpoint)
            st = stage_write(w->job, w->states, w->root, &w->frames);
        pthread_mutex_lock(&w->lock);
        if (st != OK && w->st == OK) {
            w->st = st;
            snprintf(w->message, sizeof w->message, "%s", status_message());
        }
        item_free(item);
        w->n--;
        memmove(w->queue, w->queue + 1, (size_t)w->n * sizeof *w->queue);
        pthread_cond_broadcast(&w->changed);
    }
    pthread_mutex_unlock(&w->lock);
    return NULL;
}

status writer_create(const struct job *job, const struct job_states *states, const char *root, bool blocking,
                     struct writer **out)
{
    struct writer *w = NULL;
    status st = memory_alloc(1, sizeof *w, "the writer", &w);
    if (st != OK)
        return st;
    w->job = job;
    w->states = states;
    w->root = root;
    w->blocking = blocking;
    w->last = clock_seconds();
    pthread_mutex_init(&w->lock, NULL);
    pthread_cond_init(&w->changed, NULL);
    if (pthread_create(&w->thread, NULL, writer_main, w) != 0) {
        free(w);
        return fail(E_MEMORY, "cannot create the writer thread");
    }
    *out = w;
    return OK;
}

static status enqueue(struct writer *w, struct item *item)
{
    pthread_mutex_lock(&w->lock);
    while (w->n == QUEUE && w->st == OK)
        pthread_cond_wait(&w->changed, &w->lock);
    status st = w->st;
    if (st == OK)
        w->queue[w->n++] = item;
    pthread_cond_broadcast(&w->changed);
    while (w->blocking && st == OK && w->n > 0)
        pthread_cond_wait(&w->changed, &w->lock);
    pthread_mutex_unlock(&w->lock);
    if (st != OK) {
        item_free(item);
        fail(st, "%s", w->message);
    }
    return st;
}

status writer_frame(struct writer *w, struct frame *frame)
{
    struct item *item = NULL;
    status st = memory_alloc(1, sizeof *item, "a frame to write", &item);
    if (st != OK) {
        frame_free(frame);
        return st;
    }
    item->frame = *frame;
    *frame = (struct frame){0};
    return enqueue(w, item);
}

status writer_checkpoint(struct writer *w, struct checkpoint *checkpoint)
{
    struct item *item = NULL;
    status st = memory_alloc(1, sizeof *item, "a checkpoint to write", &item);
    if (st != OK) {
        checkpoint_free(checkpoint);
        return st;
    }
    item->is_checkpoint = true;
    item->checkpoint = *checkpoint;
    *checkpoint = (struct checkpoint){0};
    return enqueue(w, item);
}

status writer_finish(struct writer **handle)
{
    struct writer *w = *handle;
    if (!w)
        return OK;
    pthread_mutex_lock(&w->lock);
    w->ending = true;
    pthread_cond_broadcast(&w->changed);
    pthread_mutex_unlock(&w->lock);
    pthread_join(w->thread, NULL);
    /* The final stage is made from all manifests, as that of a folder that is found complete, and not from the known frames. */
    status st = w->st == OK ? stage_write(w->job, w->states, w->root, NULL) : fail(w->st, "%s", w->message);
    pthread_mutex_destroy(&w->lock);
    pthread_cond_destroy(&w->changed);
    stage_frames_free(&w->frames);
    free(w);
    *handle = NULL;
    return st;
}
