#include "farm/graph.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "base/path.h"

bool graph_has_volumes(const struct job *job, int frame)
{
    return job_writes(job, JOB_VOLUMES, frame);
}

bool graph_has_still(const struct job *job, int frame)
{
    if (job->farm.still_every == 0 || !graph_has_volumes(job, frame))
        return false;
    return (frame - job->frames.first) % job->farm.still_every == 0 || frame == job->frames.last;
}

/* ---- building */

/* A name such as "w0001.show.von-mises.1001-1010". Names contain no '_'. */
static void name_task(struct farm_task *t)
{
    const bool views = farm_kinds[t->kind].cut == CUT_VIEWS;
    char wedge[FRAME_TEXT + 1] = "", number[FRAME_TEXT], value[20] = "", range[50] = "", text[48], *under;
    if (t->wedge)
        snprintf(wedge, sizeof wedge, "%s.", wedge_text(t->wedge, number));
    if (t->show)
        snprintf(value, sizeof value, ".%.15s", t->show);
    while ((under = strchr(value, '_')))
        *under = '-';
    if (farm_kind_is_cut(t->kind))
        snprintf(range, sizeof range, ".%s", range_text(views ? t->views : t->frames, text));
    snprintf(t->name, sizeof t->name, "%s%s%s%.*s", wedge, farm_kinds[t->kind].name, value, 40, range);
}

static double particles_of_surface(double particles)
{
    double side = 1;
    while (side * side * side < particles)
        side *= 1.02;
    return 6 * side * side;
}

static void estimate_task(struct farm_task *t, const struct farm_wedge *w)
{
    const struct farm_kind_info *kind = &farm_kinds[t->kind];
    const double particles = (double)w->estimate.n_particles;
    const double n = (double)(kind->items ? kind->items(w->job, t) : range_count(t->frames));
    t->host_bytes = w->estimate.host_bytes;
    if (kind->device)
        t->device_bytes = w->estimate.device_bytes;
    if (kind->cut != CUT_BLOCKS) {
        t->seconds = n * (kind->seconds + kind->particle_seconds * particles);
        t->disk_bytes = (uint64_t)(n * (kind->bytes + kind->surface_bytes * particles_of_surface(particles)));
        return;
    }
    t->seconds = n * w->frame_seconds;
    t->disk_bytes = disk_frames_bytes(w->job, &w->estimate.disk, t->frames, NULL);
    if (t->frames.first == w->job->frames.first)
        t->disk_bytes += w->estimate.checkpoint_bytes * (uint64_t)w->job->checkpoint.keep;
}

/* Appends a copy of `task`, with a name, and with estimates unless it is a task of all wedges (w is NULL). */
static status add_task(struct farm_graph *g, const struct farm_wedge *w, const struct farm_task *task)
{
    status st = memory_grow(&g->task, &g->capacity, g->n + 1, sizeof *g->task, "the tasks");
    if (st != OK)
        return st;
    struct farm_task *t = &g->task[g->n++];
    *t = *task;
    t->after = g->n_after;
    if (w) {
        t->wedge = (int)w->job->wedge.index;
        estimate_task(t, w);
    }
    name_task(t);
    return OK;
}

/* Makes the task that was added last wait for `task`. */
static status add_after(struct farm_graph *g, size_t task)
{
    status st = memory_grow(&g->after, &g->after_capacity, g->n_after + 1, sizeof *g->after, "the tasks");
    if (st != OK)
        return st;
    g->after[g->n_after++] = task;
    g->task[g->n - 1].n_after++;
    return OK;
}

/* Finds the frames of the next task: at most farm.chunk_frames evenly spaced frames of `block`, from *frame on, for which takes()
 * holds. Advances *frame behind them. False if there are none. */
static bool next_chunk(const struct job *job, bool (*takes)(const struct job *, int),
                       struct frame_range block, int *frame, struct frame_range *out)
{
    int64_t n = 0;
    for (; *frame <= block.last; *frame += block.step) {
        if (!takes(job, *frame))
            continue;
        if (n == 0)
            *out = (struct frame_range){*frame, *frame, 1};
        else if (n == job->farm.chunk_frames || (n > 1 && *frame - out->last != out->step))
            break;
        else
            *out = (struct frame_range){out->first, *frame, n == 1 ? *frame - out->first : out->step};
        n++;
    }
    return n > 0;
}

/* Adds the tasks of one kind that derive products from the frames of the block that the task `sim` simulates. */
static status add_chunks(struct farm_graph *g, const struct farm_wedge *w, enum farm_kind kind,
                         const char *show, size_t sim)
{
    status st = OK;
    const struct frame_range block = g->task[sim].frames;
    struct frame_range chunk;
    for (int frame = block.first; next_chunk(w->job, farm_kinds[kind].takes, block, &frame, &chunk);) {
        TRY(add_task(g, w, &(struct farm_task){.kind = kind, .frames = chunk, .show = show}));
        TRY(add_after(g, sim));
    }
done:
    return st;
}

/* Adds the blocks of frames of a wedge, each with the tasks that depend on it alone. *last: the task of the last block. */
static status add_blocks(struct farm_graph *g, const struct farm_wedge *w, size_t *last)
{
    status st = OK;
    const struct job *job = w->job;
    const struct frame_range all = job->frames;
    const int64_t stride = job->farm.block_frames * all.step;
    size_t sim = SIZE_MAX;
    for (int64_t at = all.first; at <= all.last; at += stride) {
        const int64_t end = at + stride - all.step;
        const struct frame_range block = {(int)at, end >= all.last ? all.last : (int)end, all.step};
        const size_t before = sim;
        sim = g->n;
        TRY(add_task(g, w, &(struct farm_task){.kind = FARM_SIM, .frames = block}));
        if (before != SIZE_MAX)
            TRY(add_after(g, before));
        for (int k = 0; k < FARM_KINDS; k++) {
            const struct farm_kind_info *kind = &farm_kinds[k];
            const size_t n = kind->wanted ? kind->wanted(job) : 1;
            for (size_t i = 0; i < n && (kind->cut == CUT_CHUNKS || kind->cut == CUT_LIST); i++)
                TRY(add_chunks(g, w, (enum farm_kind)k, kind->value ? kind->value(job, i) : NULL, sim));
        }
    }
    *last = sim;
done:
    return st;
}

/* Makes the task that was added last wait for all tasks from `first` on whose kinds its own kind comes after; of the blocks of
 * frames only for `last_sim`. */
static status add_all_after(struct farm_graph *g, size_t first, size_t last_sim)
{
    status st = OK;
    const size_t task = g->n - 1;
    const unsigned after = farm_kinds[g->task[task].kind].after;
    for (size_t i = first; i < task; i++)
        if ((after & 1u << g->task[i].kind) && (g->task[i].kind != FARM_SIM || i == last_sim))
            TRY(add_after(g, i));
done:
    return st;
}

/* Adds the tasks of one kind that depend on all frames of a wedge: one task, or several that share the turntable's views. */
static status add_finish(struct farm_graph *g, const struct farm_wedge *w, enum farm_kind kind, size_t first,
                         size_t last_sim)
{
    status st = OK;
    const struct job *job = w->job;
    const int last = job->frames.last, views = (int)job->farm.turntable, chunk = (int)job->farm.chunk_frames;
    struct farm_task t = {.kind = kind, .frames = {last, last, 1}};
    if (farm_kinds[kind].cut == CUT_VIEWS) {
        for (int at = 0; at < views; at += chunk) {
            t.views = (struct frame_range){at, views - at > chunk ? at + chunk - 1 : views - 1, 1};
            TRY(add_task(g, w, &t));
            TRY(add_all_after(g, first, last_sim));
        }
        return OK;
    }
    if (farm_kinds[kind].cut == CUT_ONCE)
        t.frames = job->frames;
    TRY(add_task(g, w, &t));
    TRY(add_all_after(g, first, last_sim));
done:
    return st;
}

static status add_wedge(struct farm_graph *g, const struct farm_wedge *w)
{
    status st = OK;
    const size_t first = g->n;
    size_t last_sim;
    TRY(add_blocks(g, w, &last_sim));
    for (int k = 0; k < FARM_KINDS; k++) {
        const struct farm_kind_info *kind = &farm_kinds[k];
        if ((kind->cut == CUT_ONCE || kind->cut == CUT_LAST || kind->cut == CUT_VIEWS) &&
            kind->wanted(w->job))
            TRY(add_finish(g, w, (enum farm_kind)k, first, last_sim));
    }
done:
    return st;
}

/* Adds a task of all wedges if at least two tasks make what it needs. */
static status add_across(struct farm_graph *g, const struct farm_wedge *wedge, enum farm_kind kind)
{
    status st = OK;
    const struct farm_kind_info *info = &farm_kinds[kind];
    const int last = wedge[0].job->frames.last;
    size_t n = 0;
    for (size_t i = 0; i < g->n; i++)
        n += (info->after >> g->task[i].kind) & 1;
    if (n < 2)
        return OK;
    TRY(add_task(g, NULL,
                 &(struct farm_task){.kind = kind,
                                     .frames = {last, last, 1},
                                     .seconds = (double)n * info->seconds,
                                     .disk_bytes = (uint64_t)((double)n * info->bytes)}));
    TRY(add_all_after(g, 0, SIZE_MAX));
done:
    return st;
}

/* Adds the task that ends the job. It waits for all others; of the blocks of frames for the last one of each wedge. */
static status add_end(struct farm_graph *g, const struct farm_wedge *wedge)
{
    status st = OK;
    const size_t n = g->n;
    const int last = wedge[0].job->frames.last;
    TRY(add_task(g, NULL, &(struct farm_task){.kind = FARM_END, .frames = {last, last, 1}}));
    for (size_t i = 0; i < n; i++) {
        size_t next = i + 1;
        while (next < n && g->task[i].kind == FARM_SIM && g->task[next].kind != FARM_SIM)
            next++;
        const bool followed =
            g->task[i].kind == FARM_SIM && next < n && g->task[next].wedge == g->task[i].wedge;
        if (!followed)
            TRY(add_after(g, i));
    }
done:
    return st;
}

status graph_make(const struct farm_wedge *wedge, size_t n_wedges, struct farm_graph *out)
{
    status st = OK;
    for (size_t i = 0; i < n_wedges; i++)
        TRY(add_wedge(out, &wedge[i]));
    for (int k = 0; k < FARM_KINDS; k++)
        if (farm_kinds[k].cut == CUT_ALL_WEDGES)
            TRY(add_across(out, wedge, (enum farm_kind)k));
    TRY(add_end(out, wedge));
done:
    return st;
}

void graph_free(struct farm_graph *g)
{
    free(g->task);
    free(g->after);
    *g = (struct farm_graph){0};
}
