/* A job made ready for a farm: its wedges, their folders, the graph, and what of it is done.
 *
 *     out/NAME/                     the only job's output folder; or, with wedges,
 *     out/NAME/w0001/ w0002/ ...    one each, whose files are called NAME_w0001.*
 *     out/NAME/farm/job.yaml        the job as it was submitted: what every task reads
 *     out/NAME/farm/slurm.json      which task is which Slurm job
 *     out/NAME/log/farm/TASK.log    what each task said
 *
 * Calling sequence   struct farm f = {0}; TRY(farm_load(...)); TRY(farm_freeze(&f)); ...; farm_free(&f);
 */
#ifndef HOODOO_FARM_FARM_H
#define HOODOO_FARM_FARM_H

#include "base/path.h"
#include "farm/graph.h"

struct farm {
    struct job *base; /* the job as loaded; the only wedge's is another copy of it */
    struct farm_wedge *wedge;
    size_t n_wedges;
    struct path root;   /* absolute */
    struct path hoodoo; /* this program */
    struct farm_graph graph;
};

/* Loads the job and its wedges and estimates them. `from`: OUT@FRAME, or NULL. `only`: 0, or the one wedge that is meant. `out`: NULL for
 * out/NAME. frame_seconds are left to the caller, and so is farm_graph(). */
MUST_USE status farm_load(const char *path, const char *const *sets, size_t n_sets, const char *from,
                          int only, const char *out, struct farm *f);
MUST_USE status farm_graph(struct farm *f);
void farm_free(struct farm *f);

/* The folder a wedge's frames go to; the farm's own for 0. */
MUST_USE status farm_root(const struct farm *f, int wedge, struct path *out);

/* The job of a task; of FARM_WEDGES the first wedge's. */
const struct job *farm_job(const struct farm *f, const struct farm_task *t);

/* Makes the folders and writes farm/job.yaml, after looking whether what is there belongs to other jobs
 * (E_CHECKPOINT). */
MUST_USE status farm_freeze(struct farm *f);

/* The median time between a folder's recent frames, in seconds; 0 if there are too few to tell. */
double farm_frame_seconds(const char *root, const char *name);

/* How many seconds before its end a scheduler tells a task, that it may finish the frame it is at and save: two of
 * the wedges' longest frames and a minute, between `least` and `most`. */
int farm_notice_seconds(const struct farm_wedge *wedge, size_t n_wedges, int least, int most);

/* How many of a wedge's frames are done, going by their manifests' names. */
size_t farm_frames_of(const struct farm *f, const struct job *wedge);

/* How many of all wedges' frames are done, going by their manifests' names; *total: how many there are. */
size_t farm_frames(const struct farm *f, size_t *total);

/* Is there nothing left for the task to do? Files are looked at, not read. */
MUST_USE status farm_task_done(const struct farm *f, const struct farm_task *t, bool *done);

/* root/log/farm/TASK.log */
MUST_USE status farm_log_path(const struct farm *f, const struct farm_task *t, struct path *out);

#endif
