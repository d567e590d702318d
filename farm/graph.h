/* The tasks a job is cut into: one pure function from jobs to a graph.
 *
 *   sim        frames a-b simulated; block n+1 of a wedge goes on from block n's last checkpoint
 *   derive     meshes and AOVs of some frames, once their block is done
 *   preview    stills of some frames, once their block is done; views of the last frame's turntable
 *   finish     contact sheet, turntable's video, and a sheet across the wedges
 *
 * Order       A task stands behind all it waits for: the list can be worked off from its start.
 * Once        Every frame of a job is simulated by exactly one task; so is every mesh, AOV, still and view made.
 * Wedges      Each has a graph of its own; they share the sheet across wedges alone.
 */
#ifndef HOODOO_FARM_GRAPH_H
#define HOODOO_FARM_GRAPH_H

#include "job/job.h"
#include "model/model.h"

enum farm_kind {
    FARM_SIM,
    FARM_MESH,
    FARM_AOV,
    FARM_STILL,
    FARM_VIEW,
    FARM_SHEET,
    FARM_TURNTABLE,
    FARM_WEDGES,
    FARM_KINDS
};

/* One job of those that are submitted together: a wedge, or the only one. */
struct farm_wedge {
    struct job *job; /* owned by struct farm */
    struct model_estimate estimate;
    double frame_seconds; /* to simulate a frame; 0: not known */
};

struct farm_task {
    enum farm_kind kind;
    int wedge;                 /* wedge.index of its job; 0: the only one, or all of them */
    struct frame_range frames; /* the ones it makes; FARM_SHEET and below: those it shows */
    struct frame_range views;  /* FARM_VIEW: which of farm.turntable views */
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

/* "sim", "derive", "preview" or "finish". */
const char *graph_kind(enum farm_kind kind);

/* Do tasks of this kind run on a Vulkan device? The others are for the CPU alone. */
bool graph_needs_device(enum farm_kind kind);

/* Does the job write volumes of this frame? What meshes and stills are made of. */
bool graph_has_volumes(const struct job *job, int frame);
bool graph_has_still(const struct job *job, int frame);

#endif
