/* What of a job would surprise whoever wrote it, though it can be run: rock outside the domain, cameras that see none, keys that its
 * model ignores, numbers far from those in which forms come about. A table of looks at the job and its scene; no device.
 */
#ifndef HOODOO_ADVICE_H
#define HOODOO_ADVICE_H

#include "job/job.h"

struct advice {
    char key[160];  /* the key's path, "strata.2.interlock_MPa" */
    char text[600]; /* a sentence with numbers */
};

struct advices {
    size_t n, capacity;
    struct advice *one; /* owned; advices_free() */
};

/* Of one job: a wedge, or the only one. `heard`: what reading its files says is not said elsewhere. E_USAGE: it cannot be run at all, for nothing of its scene stands. Otherwise as
 * scene_estimate(). */
MUST_USE status advices_of(const struct job *job, bool heard, struct advices *out);
void advices_free(struct advices *a);

/* As warnings in the log, for who is about to run it. Nothing of jobs whose files take long to read: hoodoo check says it. What is
 * wrong is found again by who runs it, and said there. E_MEMORY. */
MUST_USE status advices_log(const struct job *job);

#endif
