/* Which hoodoo on which device made what is in an output folder: run.json, and whether this one may go on with it.
 *
 * Two makers are the same where build (base/build.h), device and driver are: then a continued run writes the bytes of
 * an uninterrupted one. Another build or device is refused unless the caller allows it; each time that one goes on, the
 * maker before it is added to the list `continued` of run.json, with the frame from which it was.
 */
#ifndef HOODOO_PROVENANCE_H
#define HOODOO_PROVENANCE_H

#include "checkpoint/checkpoint.h"
#include "gpu/gpu.h"
#include "job/job.h"
#include "run/run.h"

/* A maker, and the frame whose state another one went on from. */
struct continued {
    int frame;
    struct maker maker;
};

struct provenance {
    struct maker here;
    enum run_resume allowed;
    bool known;         /* the folder has a run.json, and that names ... */
    struct maker maker; /* ... who wrote it last, after those of the list */
    size_t n, capacity;
    struct continued *continued; /* oldest first; owned */
};

/* The maker that this process is, and, unless a run starts over, what root/run.json says; where that is not there or
 * cannot be read, nothing is known. E_MEMORY. provenance_free() */
MUST_USE status provenance_begin(const struct gpu *gpu, const char *root, enum run_resume resume,
                                 struct provenance *out);
void provenance_free(struct provenance *p);

/* May this process go on from the state after `frame`, which `maker` made? `what` names it in the sentence.
 * E_CHECKPOINT if not; a warning, and an entry in the list, if it is another maker that may. */
MUST_USE status provenance_continue(struct provenance *p, const struct maker *maker, int frame,
                                    const char *what);

/* The same for frames that are in the folder where there is no checkpoint of theirs: those before them will be made
 * anew, from `first` on. */
MUST_USE status provenance_restart(struct provenance *p, int first, const char *root);

/* Writes root/job.yaml, the job with every default, and root/run.json. `gpu` may be NULL: which one it was is not known. */
MUST_USE status provenance_write(const struct provenance *p, const struct gpu *gpu, const struct job *job,
                                 uint64_t job_hash, const char *root);

/* Are both there, as their records say? E_MEMORY. */
MUST_USE status provenance_whole(const char *root, bool *whole);

/* The same for a folder whose frames are done and which has lost or damaged one of the two: job.yaml is the job; run.json stays
 * unless its record says that it is damaged, or it is another job's, and then says what the newest checkpoint says of who made it. E_OUTPUT, E_MEMORY. */
MUST_USE status provenance_restore(const struct job *job, uint64_t job_hash, const char *root);

#endif
