/* A run: a job simulated into an output folder, from wherever it stands.
 *
 * Done        A frame is done when its manifest is there, is of this job, and its files have the sizes it
 *             says.
 * Resume      The first frame that is not done is where work begins: from the newest sound checkpoint up to
 *             it, or from the job's first frame. Frames simulated on the way that are done already are not
 *             written again.
 *             It ends with the last frame that is not done, if the last frame's checkpoint is there.
 * Branches    A job with `from` begins with that checkpoint (branch.h): its first frame becomes the checkpoint's.
 * Marks       Frames in checkpoint.mark have their checkpoints made, if need be by simulating up to them again, and
 *             kept.
 * Refusals    E_CHECKPOINT: the folder belongs to another job; a checkpoint, or frames that have none, to another
 *             build of hoodoo or another device (provenance.h); or the first frame asked for is not the job's
 *             first and there is no checkpoint before it.
 * Repair      As above, but files are read, not only looked at, damaged checkpoints are removed, and a range of
 *             frames without a checkpoint before it is reached from the job's first frame.
 * Alone       root/lock (base/lock.h) keeps a second writer out: E_OUTPUT. A run with nothing to do needs no
 *             lock.
 * Stop        When a stop is requested, the frame under way is finished and written, then a checkpoint:
 *             STOPPED.
 */
#ifndef HOODOO_RUN_H
#define HOODOO_RUN_H

#include <stdbool.h>

#include "base/ranges.h"
#include "gpu/gpu.h"
#include "job/job.h"

enum run_resume { RUN_AUTO, RUN_NEVER, RUN_REQUIRE, RUN_OTHER_DEVICE, RUN_OTHER_BUILD, RUN_OTHER_BOTH };

struct run_options {
    const char *root;          /* the output folder */
    const char *device;        /* gpu_options */
    struct frame_range frames; /* which of the job's to produce; step 0: all */
    enum run_resume resume;
    bool repair; /* make damaged and missing checkpoints again, too, from the start if need be */

    /* What the caller shows. Any may be NULL. */
    void (*begin)(void *user, struct frame_range frames, size_t done);
    void (*frame)(void *user, int frame, double volume_share, int stress_iterations);
    bool (*stop)(void);
    void *user;
};

MUST_USE status run_job(struct job *job, const struct run_options *options);

/* E_CHECKPOINT: the folder, whose job.yaml is `path`, holds `theirs` and not `ours`; says in what they differ. */
status run_other_job(const char *root, const char *path, const struct job *theirs, const struct job *ours);

/* E_CHECKPOINT: there are frames, and their files would be written otherwise now. OK: all would be alike. */
MUST_USE status run_other_files(const char *root, const struct job *theirs, const struct job *ours);

#endif
