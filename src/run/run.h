/* A run: simulates a job into an output folder, continuing from whatever the folder already has.
 *
 * Done        A frame is done when its manifest exists and belongs to this job, and its files are as the manifest lists them.
 * Resume      Work starts at the first frame that is not done, from the newest sound checkpoint at or before that frame, or from the
 *             job's first frame. Frames passed on the way that are already done are not written again. Work ends at the last frame that
 *             is not done, provided that the checkpoint of the last frame exists. If the folder has no checkpoint at all and later frames of
 *             the job are missing, that of the last frame is made, too.
 * Changes     With `change`, a job that differs from the folder's only from a frame on keeps the frames before (owner.h).
 * Branches    A job with `from` starts from that checkpoint (branch.h), whose frame becomes the job's first.
 * Marks       The checkpoints of the frames in checkpoint.mark are kept; missing ones are made, by simulating again if necessary.
 * Refusals    E_CHECKPOINT: the folder belongs to another job; a checkpoint, or frames without one, were made by another build of
 *             hoodoo or on another device (provenance.h); or the first requested frame is not the job's first and there is no
 *             checkpoint before it.
 * Repair      As resume, but damaged checkpoints are removed and made again, and a range of frames with no checkpoint before it is
 *             simulated from the job's first frame.
 * Exclusive   root/lock (system/lock.h) keeps a second writer out: E_OUTPUT. A run that has nothing to do takes no lock.
 * Stop        When a stop is requested, the current frame is finished and written, then a checkpoint; the run returns STOPPED.
 */
#ifndef HOODOO_RUN_H
#define HOODOO_RUN_H

#include <stdbool.h>

#include "gpu/gpu.h"
#include "job/job.h"
#include "text/ranges.h"

enum run_resume { RUN_AUTO, RUN_NEVER, RUN_REQUIRE, RUN_OTHER_DEVICE, RUN_OTHER_BUILD, RUN_OTHER_BOTH };

struct run_options {
    const char *root;          /* the output folder */
    const char *device;        /* as in gpu_options */
    struct frame_range frames; /* the frames to produce; step 0: all of the job's */
    enum run_resume resume;
    bool
        repair; /* also replace damaged and missing checkpoints, if necessary by simulating from the first frame */

    bool change; /* take over a folder whose job has the same states up to some frame */

    /* Callbacks for progress and stopping; each may be NULL. */
    void (*begin)(void *user, struct frame_range frames, size_t done);
    void (*frame)(void *user, int frame, double volume_share, int stress_iterations);
    void (*stage)(void *user, int frame, const char *name); /* a stage of a frame begins */
    bool (*stop)(void);
    void *user;
};

MUST_USE status run_job(struct job *job, const struct run_options *options);

/* What run_job() with `change` does before it simulates: says what is kept and what is overwritten; with `change`, records the job and removes
 * the frames that differ, so that any run of this job makes them again. `job` is prepared (branch_prepare()). Nothing happens in a folder
 * without a job, or of this one. Errors as run_job(). */
MUST_USE status run_take_over(const struct job *job, const char *root, bool change);

#endif
