/* Branches: runs that start from a checkpoint of another run instead of the job's scene (the key `from`).
 *
 * The content of the checkpoint is part of the branch's job hash. A copy of it is kept in the branch's folder as
 * checkpoint/NAME.from.ckpt, so that the branch can be continued after the other run is deleted. The first frame of a branch is
 * the frame of the checkpoint. Edits up to that frame are not applied again, because the checkpoint already contains the rock
 * they made, but the keys that they set remain in force.
 *
 * The spacing may be another one: a whole fraction or a whole multiple of the other run's (src/resample). The copy is of the checkpoint as it
 * was; the state is resampled when the branch starts from it.
 */
#ifndef HOODOO_BRANCH_H
#define HOODOO_BRANCH_H

#include "base/path.h"
#include "base/status.h"
#include "checkpoint/checkpoint.h"
#include "job/job.h"

/* The --set that must be given when loading a job for branch_from(): it tells the job's checks that this is a branch, which may
 * have edits before its first frame. */
#define BRANCH_SET "from=checkpoint"

/* Path of the copy, whether it exists or not: ROOT/checkpoint/NAME.from.ckpt. */
MUST_USE status branch_copy_path(struct path *out, const char *root, const char *name);

/* Sets the job's `from` to the checkpoint that `text`, "OUT@FRAME" as given to --from, names. `root` is the branch's own folder.
 * E_USAGE: text has another form. E_INPUT: OUT is not an output folder. E_CHECKPOINT: OUT has no checkpoint for that frame; the
 * message lists the frames that have one. */
MUST_USE status branch_from(struct job *job, const char *text, const char *root);

/* Prepares a job with `from`: sets its first frame to the frame of the checkpoint. If the checkpoint file is gone, the copy in
 * `root` is used. A job without `from` is not changed. E_INPUT, E_CHECKPOINT: missing or damaged. E_USAGE: the checkpoint's frame
 * is outside of the job's frames. */
MUST_USE status branch_prepare(struct job *job, const char *root);

/* The same for the job.yaml stored in `root`, which always uses the copy in that folder. */
MUST_USE status branch_prepare_own(struct job *job, const char *root);

/* The state that a branch starts from, at the job's spacing. */
struct branch_state {
    struct checkpoint at; /* free with checkpoint_free() */
    double spacing_m;     /* of the other run */
};

/* Reads the state that a prepared branch starts from; without a folder, or after copying the checkpoint into `root`. Errors of
 * checkpoint_read() and model_resample(). */
MUST_USE status branch_load(const struct job *job, struct branch_state *out);
MUST_USE status branch_read(const struct job *job, const char *root, struct branch_state *out);

#endif
