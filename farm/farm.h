/* A job prepared for a farm: its wedges, their folders, the graph of tasks, and which tasks are done.
 *
 *     out/NAME/                     the output folder of a job without wedges; or, with wedges,
 *     out/NAME/w0001/ w0002/ ...    a folder for each, whose files are named NAME_w0001.*
 *     out/NAME/farm/job.yaml        the job as it was submitted: every task reads this file
 *     out/NAME/farm/submission.json where and how it was submitted (submission.h)
 *     out/NAME/farm/slurm.json      the Slurm job of each task
 *     out/NAME/farm/end.json        how the job ended (end.h)
 *     out/NAME/log/farm/TASK.log    what each task wrote
 *     out/NAME/log/farm/TASK.jsonl  when and where each task started and ended (tries.h)
 *
 * Calling sequence   struct farm f = {0}; TRY(farm_load(...)); TRY(farm_graph(&f)); TRY(farm_freeze(&f)); ...; farm_free(&f);
 */
#ifndef HOODOO_FARM_FARM_H
#define HOODOO_FARM_FARM_H

#include "base/path.h"
#include "farm/graph.h"

struct farm {
    struct job *base; /* the job as loaded; the wedge of a job without wedges has a copy */
    struct farm_wedge *wedge;
    size_t n_wedges;
    struct path root;   /* absolute */
    struct path hoodoo; /* path of this program */
    struct farm_graph graph;
    bool *chosen; /* [graph.n]: the tasks to submit; NULL: all. farm_choose() */
};

/* Loads the job and its wedges and estimates them. `from`: OUT@FRAME, or NULL. `only`: the wedge to load; 0: all. `out`: NULL for
 * out/NAME. The caller sets frame_seconds of each wedge, if known, and calls farm_graph(). */
MUST_USE status farm_load(const char *path, const char *const *sets, size_t n_sets, const char *from,
                          int only, const char *out, struct farm *f);
MUST_USE status farm_graph(struct farm *f);
void farm_free(struct farm *f);

/* Loads a submitted job from its output folder, with its graph; frame times come from the frames in the folder. E_INPUT: `root` was
 * not made by hoodoo submit. */
MUST_USE status farm_open(const char *root, struct farm *f);

/* The folder of a wedge's frames; the farm's own for wedge 0. */
MUST_USE status farm_root(const struct farm *f, int wedge, struct path *out);

/* The job of a task; for a task of all wedges, the first wedge's. */
const struct job *farm_job(const struct farm *f, const struct farm_task *t);

/* How often the task is tried again: farm.retries; the task that ends the job is not. */
int farm_retries(const struct farm *f, const struct farm_task *t);

/* Chooses what `hoodoo retry OUT TASK` submits: the task, and the tasks behind it whose other prerequisites are chosen, done or in
 * `active` (NULL: none are). E_USAGE: the task is done or active, or waits for a task that is neither. */
MUST_USE status farm_choose(struct farm *f, size_t task, const bool *active);

/* Makes the folders and writes farm/job.yaml. E_CHECKPOINT: the folder holds frames of another job. */
MUST_USE status farm_freeze(struct farm *f);

/* E_OUTPUT: a process of this machine runs the folder's tasks already; two would fail each other's. */
MUST_USE status farm_check_alone(const char *root);

/* For a job that was changed from some frame on since it ran in this folder: takes over the folder of each wedge (run_take_over()), so that
 * what is before the change counts as done. With `dry_run` only says what would be overwritten. E_CHECKPOINT: a wedge has no frame to keep;
 * then none is touched. E_OUTPUT: tasks run or are queued. */
MUST_USE status farm_change(struct farm *f, bool dry_run);

/* Sets frame_seconds of each wedge from the frames in its folder; 0 where there are too few. */
MUST_USE status farm_measure(struct farm *f);

/* How many seconds before its end a scheduler must notify a task, so that it can finish its frame and save: two of the
 * wedges' longest frames and a minute, between `least` and `most`. */
int farm_notice_seconds(const struct farm_wedge *wedge, size_t n_wedges, int least, int most);

/* How many of a wedge's frames are done, by the names of their manifests. */
size_t farm_frames_of(const struct farm *f, const struct job *wedge);

/* The same of all wedges; *total: all their frames. */
size_t farm_frames(const struct farm *f, size_t *total);

/* Whether the task has nothing left to do. Sizes and records of files are compared; their content is not read. */
MUST_USE status farm_task_done(const struct farm *f, const struct farm_task *t, bool *done);

/* Whether the job ended with every task done (end.h). */
MUST_USE status farm_ended(const struct farm *f, bool *done);

/* Calls each(user, path) for every file that the task makes, relative to the farm's folder; of a block of frames, for the frames'
 * manifests, which list their files. */
MUST_USE status farm_task_outputs(const struct farm *f, const struct farm_task *t,
                                  status (*each)(void *user, const char *path), void *user);

/* The index of the task of that name. E_USAGE: no such task; the message names the nearest. */
MUST_USE status farm_find(const struct farm *f, const char *name, size_t *out);

/* root/log/farm/TASK.log */
MUST_USE status farm_log_path(const struct farm *f, const struct farm_task *t, struct path *out);

#endif
