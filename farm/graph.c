#include "farm/graph.h"

#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"

/* Seconds of one core, measured on jobs/demo.yaml's frames; they only tell a minute from an hour. */
static const double MESH_S = 0.2, AOV_S = 1, MESH_PARTICLE_S = 4e-6, STILL_S = 1.5, STILL_PARTICLE_S = 2e-6,
                    VIEW_S = 1.5, VIEW_PARTICLE_S = 1e-6, VIDEO_S = 0.1, SHEET_S = 0.1;
/* Bytes of a mesh for each particle of the surface, PLY and OBJ; of a picture. */
enum {
    MESH_BYTES = 220,
    AOV_BYTES = 4000000,
    STILL_BYTES = 400000,
    VIEW_BYTES = 200000,
    VIDEO_BYTES = 60000
};

const char *graph_kind(enum farm_kind kind)
{
    static const char *const names[FARM_KINDS] = {"sim",     "derive", "derive", "preview",
                                                  "preview", "finish", "finish", "finish"};
    return names[kind];
}

bool graph_has_volumes(const struct job *job, int frame)
{
    return (frame - job->frames.first) % job->output.vdb.every == 0 || frame == job->frames.last;
}

bool graph_has_still(const struct job *job, int frame)
{
    if (job->farm.still_every == 0 || !graph_has_volumes(job, frame))
        return false;
    return (frame - job->frames.first) % job->farm.still_every == 0 || frame == job->frames.last;
}

bool graph_needs_device(enum farm_kind kind)
{
    return kind == FARM_SIM || kind == FARM_AOV;
}

/* ---- building */

static status add_task(struct farm_graph *g, const struct farm_wedge *w, enum farm_kind kind,
                       struct frame_range frames, struct farm_task **out)
{
    static const char *const names[FARM_KINDS] = {"sim",   "mesh",  "aov",       "still",
                                                  "views", "sheet", "turntable", "wedges"};
    char wedge[16] = "", range[48];
    status st = memory_grow(&g->task, &g->capacity, g->n + 1, sizeof *g->task, "the tasks");
    if (st != OK)
        return st;
    struct farm_task *t = &g->task[g->n++];
    *t = (struct farm_task){.kind = kind, .frames = frames, .after = g->n_after};
    if (w) {
        t->wedge = (int)w->job->wedge.index;
        t->host_bytes = w->estimate.host_bytes;
    }
    if (t->wedge)
        snprintf(wedge, sizeof wedge, "w%04d.", t->wedge);
    if (kind < FARM_SHEET)
        snprintf(t->name, sizeof t->name, "%s%s.%s", wedge, names[kind], range_text(frames, range));
    else
        snprintf(t->name, sizeof t->name, "%s%s", wedge, names[kind]);
    *out = t;
    return OK;
}

/* The task added last waits for `task` too. */
static status add_after(struct farm_graph *g, size_t task)
{
    status st = memory_grow(&g->after, &g->after_capacity, g->n_after + 1, sizeof *g->after, "the tasks");
    if (st != OK)
        return st;
    g->after[g->n_after++] = task;
    g->task[g->n - 1].n_after++;
    return OK;
}

static double bytes_of_meshes(const struct farm_wedge *w)
{
    double side = 1, n = (double)w->estimate.n_particles;
    while (side * side * side < n)
        side *= 1.02;
    return 6 * side * side * MESH_BYTES;
}

static void estimate_task(struct farm_task *t, const struct farm_wedge *w, bool first_block)
{
    double n = (double)range_count(t->frames), particles = (double)w->estimate.n_particles;
    switch (t->kind) {
    case FARM_SIM:
        t->seconds = n * w->frame_seconds;
        t->device_bytes = w->estimate.device_bytes;
        t->disk_bytes = (uint64_t)n * w->estimate.frame_bytes;
        if (first_block)
            t->disk_bytes += w->estimate.checkpoint_bytes * (uint64_t)w->job->checkpoint.keep;
        break;
    case FARM_MESH:
        t->seconds = n * (MESH_S + MESH_PARTICLE_S * particles);
        t->disk_bytes = (uint64_t)(n * bytes_of_meshes(w));
        break;
    case FARM_AOV:
        t->seconds = n * (double)w->job->farm.n_cameras * (AOV_S + MESH_PARTICLE_S * particles);
        t->device_bytes = w->estimate.device_bytes;
        t->disk_bytes = (uint64_t)n * w->job->farm.n_cameras * AOV_BYTES;
        break;
    case FARM_STILL:
        t->seconds = n * (STILL_S + STILL_PARTICLE_S * particles);
        t->disk_bytes = (uint64_t)n * STILL_BYTES;
        break;
    case FARM_VIEW:
        n = (double)range_count(t->views);
        t->seconds = n * (VIEW_S + VIEW_PARTICLE_S * particles);
        t->disk_bytes = (uint64_t)n * VIEW_BYTES;
        break;
    case FARM_TURNTABLE:
        t->seconds = (double)w->job->farm.turntable * VIDEO_S;
        t->disk_bytes = (uint64_t)w->job->farm.turntable * VIDEO_BYTES;
        break;
    case FARM_SHEET:
    case FARM_WEDGES:
    case FARM_KINDS:
        t->seconds = n * SHEET_S;
        t->disk_bytes = (uint64_t)n * STILL_BYTES;
        break;
    }
}

/* The next run of frames in `block`, from *frame on, that are wanted and evenly apart: a task's worth. */
static bool next_chunk(const struct job *job, bool (*wanted)(const struct job *, int),
                       struct frame_range block, int *frame, struct frame_range *out)
{
    int64_t n = 0;
    for (; *frame <= block.last; *frame += block.step) {
        if (!wanted(job, *frame))
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

static status add_chunks(struct farm_graph *g, const struct farm_wedge *w, enum farm_kind kind,
                         struct frame_range block, size_t sim)
{
    status st = OK;
    struct farm_task *t;
    struct frame_range chunk;
    bool (*wanted)(const struct job *, int) = kind == FARM_STILL ? graph_has_still : graph_has_volumes;
    for (int frame = block.first; next_chunk(w->job, wanted, block, &frame, &chunk);) {
        TRY(add_task(g, w, kind, chunk, &t));
        estimate_task(t, w, false);
        TRY(add_after(g, sim));
    }
done:
    return st;
}

/* The views of the last frame's turntable, in tasks as large as those of stills. */
static status add_views(struct farm_graph *g, const struct farm_wedge *w, size_t last_sim)
{
    status st = OK;
    struct farm_task *t;
    const int views = (int)w->job->farm.turntable, chunk = (int)w->job->farm.chunk_frames;
    const int frame = w->job->frames.last;
    for (int at = 0; at < views; at += chunk) {
        struct frame_range which = {at, views - at > chunk ? at + chunk - 1 : views - 1, 1};
        char range[48];
        TRY(add_task(g, w, FARM_VIEW, (struct frame_range){frame, frame, 1}, &t));
        t->views = which;
        /* Called after the views: the frame is always the last. */
        snprintf(strrchr(t->name, '.') + 1, 48, "%s", range_text(which, range));
        estimate_task(t, w, false);
        TRY(add_after(g, last_sim));
    }
done:
    return st;
}

static status add_finish(struct farm_graph *g, const struct farm_wedge *w, size_t first, size_t last_sim,
                         size_t *sheet)
{
    status st = OK;
    struct farm_task *t;
    *sheet = SIZE_MAX;
    if (w->job->farm.still_every) {
        *sheet = g->n;
        TRY(add_task(g, w, FARM_SHEET, w->job->frames, &t));
        estimate_task(t, w, false);
        for (size_t i = first; i < *sheet; i++)
            if (g->task[i].kind == FARM_STILL)
                TRY(add_after(g, i));
    }
    if (w->job->farm.turntable) {
        int last = w->job->frames.last;
        size_t first_view = g->n;
        TRY(add_views(g, w, last_sim));
        size_t end_views = g->n;
        TRY(add_task(g, w, FARM_TURNTABLE, (struct frame_range){last, last, 1}, &t));
        estimate_task(t, w, false);
        for (size_t i = first_view; i < end_views; i++)
            TRY(add_after(g, i));
        /* It makes a sheet of its own where there is none. */
        if (*sheet != SIZE_MAX)
            TRY(add_after(g, *sheet));
    }
done:
    return st;
}

static status add_wedge(struct farm_graph *g, const struct farm_wedge *w, size_t *sheet)
{
    status st = OK;
    const struct frame_range all = w->job->frames;
    const int64_t size = w->job->farm.block_frames;
    const size_t first = g->n;
    size_t sim = SIZE_MAX;
    struct farm_task *t;
    for (int64_t at = all.first; at <= all.last; at += size * all.step) {
        int64_t last = at + (size - 1) * all.step;
        struct frame_range block = {(int)at, last >= all.last ? all.last : (int)last, all.step};
        size_t before = sim;
        sim = g->n;
        TRY(add_task(g, w, FARM_SIM, block, &t));
        estimate_task(t, w, before == SIZE_MAX);
        if (before != SIZE_MAX)
            TRY(add_after(g, before));
        if (w->job->farm.meshes)
            TRY(add_chunks(g, w, FARM_MESH, block, sim));
        if (w->job->farm.n_cameras)
            TRY(add_chunks(g, w, FARM_AOV, block, sim));
        TRY(add_chunks(g, w, FARM_STILL, block, sim));
    }
    TRY(add_finish(g, w, first, sim, sheet));
done:
    return st;
}

status graph_make(const struct farm_wedge *wedge, size_t n_wedges, struct farm_graph *out)
{
    status st = OK;
    size_t *sheet = NULL, n_sheets = 0;
    struct farm_task *t;
    TRY(memory_alloc(n_wedges, sizeof *sheet, "the tasks", &sheet));
    for (size_t i = 0; i < n_wedges; i++) {
        TRY(add_wedge(out, &wedge[i], &sheet[i]));
        n_sheets += sheet[i] != SIZE_MAX;
    }
    if (n_sheets > 1) {
        int last = wedge[0].job->frames.last;
        TRY(add_task(out, NULL, FARM_WEDGES, (struct frame_range){last, last, 1}, &t));
        t->seconds = (double)n_sheets * SHEET_S;
        t->disk_bytes = n_sheets * STILL_BYTES;
        for (size_t i = 0; i < n_wedges; i++)
            if (sheet[i] != SIZE_MAX)
                TRY(add_after(out, sheet[i]));
    }
done:
    free(sheet);
    return st;
}

void graph_free(struct farm_graph *g)
{
    free(g->task);
    free(g->after);
    *g = (struct farm_graph){0};
}
