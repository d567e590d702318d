/* The tasks a job is cut into: one pure function from jobs to a graph.
 *
 * The kinds of tasks are in kinds.def: blocks of simulated frames, of which each goes on from the last checkpoint of
 * the one before it; what is derived from a block's frames; and what is made of all of them at the end.
 *
 * Order       A task stands behind all it waits for: the list can be worked off from its start.
 * Once        Every frame of a job is simulated by exactly one task; so is every mesh, AOV, still and view made.
 * Wedges      Each has a graph of its own; they share the sheet across wedges alone.
 */
#ifndef HOODOO_FARM_GRAPH_H
#define HOODOO_FARM_GRAPH_H

#include "farm/kinds.h"
#include "job/job.h"
#include "model/model.h"

/* One job of those that are submitted together: a wedge, or the only one. */
struct farm_wedge {
    struct job *job; /* owned by struct farm */
    struct model_estimate estimate;
    double frame_seconds; /* to simulate a frame; 0: not known */
};

struct farm_task {
    enum farm_kind kind;
    int wedge;                 /* wedge.index of its job; 0: the only one, or all of them */
    struct frame_range frames; /* the ones it makes, or those it shows */
    const char *show;          /* which value of farm.show, the job's own text; NULL: none */
    struct frame_range views;  /* CUT_VIEWS: which of farm.turntable views */
    char name[80];             /* unique: "w0001.sim.1001-1050". Letters, digits, dots, '-' */
    size_t after, n_after;     /* graph->after[after ...]: tasks it waits for, all before it */
    double seconds;            /* of machine time; 0: not known */
    uint64_t device_bytes, host_bytes, disk_bytes;
};

struct farm_graph {
    struct farm_task *task;
    size_t n, capacity;
    size_t *after; /* indices of tasks */
    size_t n_after, after_capacity;
};

/* {0} is an empty graph; freed with graph_free(), also after an error (memory alone). */
MUST_USE status graph_make(const struct farm_wedge *wedge, size_t n_wedges, struct farm_graph *out);
void graph_free(struct farm_graph *graph);

/* Does the job write volumes of this frame? What meshes and stills are made of. */
bool graph_has_volumes(const struct job *job, int frame);
bool graph_has_still(const struct job *job, int frame);

#endif
