/* Branches: runs that begin with a checkpoint of another run instead of the job's scene (the key `from`).
 *
 * The checkpoint's content is part of the branch's job hash, and a copy of it stays in the branch's folder as
 * checkpoint/NAME.from.ckpt, so that the branch can be continued when the other run is gone. A branch's first frame is
 * the checkpoint's; edits up to it are taken to be in the checkpoint already, but what they set holds.
 */
#ifndef HOODOO_BRANCH_H
#define HOODOO_BRANCH_H

#include "base/path.h"
#include "base/status.h"
#include "checkpoint/checkpoint.h"
#include "job/job.h"

/* What --set has to say while a job is loaded that branch_from() is for: a branch may have edits before its first
 * frame. */
#define BRANCH_SET "from=checkpoint"

/* Where the copy is, or would be: ROOT/checkpoint/NAME.from.ckpt. */
MUST_USE status branch_copy(struct path *out, const char *root, const char *name);

/* Sets the job's `from` by "OUT@FRAME", as --from gives it; `root` is the branch's own folder. E_USAGE: not of that
 * form. E_INPUT: OUT is no output folder. E_CHECKPOINT: it has no checkpoint of that frame; those there are are listed.
 */
MUST_USE status branch_from(struct job *job, const char *text, const char *root);

/* Makes a job with `from` begin with its checkpoint's frame. Where that file is gone, the copy in `root` takes its
 * place. Other jobs stay as they are. E_INPUT, E_CHECKPOINT: missing or damaged. E_USAGE: not one of the job's frames.
 */
MUST_USE status branch_prepare(struct job *job, const char *root);

/* The same for the job.yaml found in `root`: the copy there is what it began with. */
MUST_USE status branch_prepare_own(struct job *job, const char *root);

/* The checkpoint a prepared branch begins with, after putting a copy of it into `root`. checkpoint_free(). */
MUST_USE status branch_read(const struct job *job, const char *root, struct checkpoint *out);

#endif
