/* Provenance: which build of hoodoo on which device made the content of an output folder, as run.json records it, and whether this
 * process may continue it.
 *
 * Two makers are the same if their build (base/build.h), device and driver are the same; then a continued run writes the same
 * bytes as an uninterrupted one. Another build or device is refused unless the caller allows it with --resume. Each time that
 * another maker continues a run, the previous maker is appended to the list `continued` of run.json, with the frame whose state
 * was continued. Each time that a changed job takes over the folder (owner.h), the change is appended to the list `changed`.
 */
#ifndef HOODOO_PROVENANCE_H
#define HOODOO_PROVENANCE_H

#include "checkpoint/checkpoint.h"
#include "gpu/gpu.h"
#include "job/job.h"
#include "run/owner.h"
#include "run/run.h"

/* A previous maker, and the frame whose state the next maker continued. */
struct continued {
    int frame;
    struct maker maker;
};

struct provenance {
    struct maker here; /* this process */
    enum run_resume allowed;
    bool known;         /* the folder has a run.json, which names ... */
    struct maker maker; /* ... the last maker; those before are in the list */
    size_t n, capacity;
    struct continued *continued; /* oldest first; owned */
    double from_m; /* the spacing of the checkpoint that a branch started from, m; 0: not known */
    size_t n_changes, change_capacity;
    struct change *change; /* oldest first; owned */
};

/* Fills in this process's maker and, unless the run starts over, what root/run.json records. If that file is missing or cannot be
 * read, out->known is false. E_MEMORY. Free with provenance_free(). */
MUST_USE status provenance_begin(const struct gpu *gpu, const char *root, enum run_resume resume,
                                 struct provenance *out);
void provenance_free(struct provenance *p);

/* Checks that this process may continue the state after `frame`, made by `maker`. `what` names that state in messages.
 * E_CHECKPOINT if it may not. If it is another, allowed maker: logs a warning and appends it to the list. */
MUST_USE status provenance_continue(struct provenance *p, const struct maker *maker, int frame,
                                    const char *what);

/* The same where the folder has frames but no usable checkpoint: the run starts over from frame `first`, and the frames in the
 * folder must be ones that this process would reproduce. */
MUST_USE status provenance_restart(struct provenance *p, int first, const char *root);

/* Appends a change to the list, if there is one. E_MEMORY. */
MUST_USE status provenance_change(struct provenance *p, const struct change *change);

/* Writes root/job.yaml (the job with all defaults filled in) and root/run.json. `gpu` may be NULL if the device is not known. */
MUST_USE status provenance_write(const struct provenance *p, const struct gpu *gpu, const struct job *job,
                                 uint64_t job_hash, const char *root);

/* Whether both files exist and match their records. E_MEMORY. */
MUST_USE status provenance_intact(const char *root, bool *intact);

/* Rewrites the two files in a folder whose frames are done and that has lost or damaged one of them. job.yaml is written from the
 * job. run.json is kept unless its record shows that it is damaged or it belongs to another job; then it is rewritten with the
 * maker that the newest checkpoint names. A change is recorded. E_OUTPUT, E_MEMORY. */
MUST_USE status provenance_restore(const struct job *job, uint64_t job_hash, const struct change *change,
                                   const char *root);

#endif
