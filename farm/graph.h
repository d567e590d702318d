/* The tasks of a job: one pure function from jobs to a graph.
 *
 * kinds.def declares the kinds of tasks. Blocks of frames are simulated one after the other, each from the last checkpoint of the
 * block before it. Other tasks derive products from the frames of one block, or from all frames at the end.
 *
 * Order       Each task follows all tasks that it waits for, so the list can be run from its start.
 * Once        Exactly one task simulates each frame of a job; the same holds for every mesh, AOV, still and view.
 * Wedges      Each wedge has its own tasks. Only the sheet of all wedges and the task `end` depend on several wedges.
 */
#ifndef HOODOO_FARM_GRAPH_H
#define HOODOO_FARM_GRAPH_H

#include "farm/kinds.h"
#include "job/job.h"
#include "model/model.h"

/* A job that is submitted with others, one per wedge, or alone. */
struct farm_wedge {
    struct job *job; /* owned by struct farm */
    struct model_estimate estimate;
    double frame_seconds; /* time to simulate a frame; 0: not known */
};

struct farm_task {
    enum farm_kind kind;
    int wedge; /* wedge.index of its job; 0: the job has no wedges, or the task is of all wedges */
    struct frame_range frames; /* the frames that it makes, or whose products it makes */
    const char *show;          /* a value of farm.show, borrowed from the job; NULL: none */
    struct frame_range views;  /* CUT_VIEWS: views of the turntable, of 0 to farm.turntable - 1 */
    char name[80];             /* unique: "w0001.sim.1001-1050". Letters, digits, dots, '-' */
    size_t after,
        n_after;    /* it waits for graph->after[after ... after + n_after - 1], which all precede it */
    double seconds; /* machine time; 0: not known */
    uint64_t device_bytes, host_bytes, disk_bytes;
};

struct farm_graph {
    struct farm_task *task;
    size_t n, capacity;
    size_t *after; /* indices of tasks */
    size_t n_after, after_capacity;
};

/* Adds the tasks of all wedges to *out, which starts as {0}. The caller frees it with graph_free(), also after an error. E_MEMORY. */
MUST_USE status graph_make(const struct farm_wedge *wedge, size_t n_wedges, struct farm_graph *out);
void graph_free(struct farm_graph *graph);

/* Whether the job writes volumes of this frame, from which meshes and stills are made. */
bool graph_has_volumes(const struct job *job, int frame);

/* Whether a still is made of this frame (farm.still_every). */
bool graph_has_still(const struct job *job, int frame);

#endif
