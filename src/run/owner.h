/* Whose folder is it? A folder belongs to the job of its job.yaml. Another job is refused, or takes the folder over if it has the same
 * states up to some frame (`hoodoo run --continue`).
 *
 * Taking over   The new job is written to run.json and job.yaml; from then on the folder is one of the new job that lacks frames. Then
 *               the old frames from the first that differs on are removed. A run that is killed at any time is continued by the same
 *               command and, once job.yaml is the new job's, by any run of that job: manifests and checkpoints name the state that they
 *               belong to (job_states()), so that those of the old job do not count.
 */
#ifndef HOODOO_RUN_OWNER_H
#define HOODOO_RUN_OWNER_H

#include <stdbool.h>

#include "job/job.h"

/* The change by which a job took over the folder of another. */
struct change {
    bool any;
    int frame;         /* the first frame that differs */
    uint64_t job_hash; /* of the job before */
};

/* Returns E_CHECKPOINT: the folder's job.yaml, read from `path`, is the job `theirs` and not `ours`; the message names the first
 * key that differs, and from which frame on. Other errors as job_states(). */
status owner_refuse(const char *root, const char *path, const struct job *theirs, const struct job *ours);

/* E_CHECKPOINT if the folder has frames whose files `ours` would write differently, for example with other cameras. */
MUST_USE status owner_check_files(const char *root, const struct job *theirs, const struct job *ours);

/* E_CHECKPOINT: these frames were written with another `key`. */
status owner_refuse_mixed(const char *root, struct frame_range frames, const char *key);

/* Finds out from which frame on the job with the states `ours` differs from the folder's job, and logs what is kept and what will be
 * overwritten. E_CHECKPOINT if no frame can be kept, or as owner_check_files(). */
MUST_USE status owner_change(const char *root, const char *path, const struct job *theirs,
                             const struct job *job, const struct job_states *ours, struct change *out);

/* The states of the job in the folder's job.yaml, by which frames of other jobs are told from its own. out->n is 0 if they cannot be told: then
 * *why is the reason, as text: an input file of the job is missing, or *edited: job.yaml is not the job that made the frames. Free with
 * job_states_free(). E_INPUT: job.yaml or run.json cannot be read. */
MUST_USE status owner_states(const char *root, struct job_states *out, bool *edited, char why[600]);

/* For verbs that read frames: owner_states(), with a warning if job.yaml is not the job of the frames. E_INPUT: a frame in `frames` (step 0:
 * any) belongs to another job. */
MUST_USE status owner_check_frames(const char *root, const char *name, struct frame_range frames,
                                   struct job_states *out);

/* Removes manifests, files and checkpoints from frame `first` on. */
MUST_USE status owner_discard(const char *root, const char *name, int first);

#endif
