/* Warnings about a job that can be run but probably does not do what its author expects: rock outside the domain, cameras that do
 * not see it, keys that the model ignores, rates at which nothing happens or everything goes. A table of checks that look at the job
 * and its scene; no device is needed.
 */
#ifndef HOODOO_ADVICE_H
#define HOODOO_ADVICE_H

#include "job/job.h"

struct advice {
    char key[160];  /* path of the key, such as "strata.2.interlock_MPa" */
    char text[600]; /* one sentence with numbers */
};

struct advice_list {
    size_t n, capacity;
    struct advice *item; /* owned; advice_free() */
};

/* Collects the advice for one job (one wedge of a sweep). `log_inputs`: also reads the files of paint and edits, and logs what reading
 * files reports, which the caller has not logged yet. E_USAGE: the job cannot be run at all, because no rock of its scene is held up. Other errors
 * as scene_estimate(). */
MUST_USE status advice_collect(const struct job *job, bool log_inputs, struct advice_list *out);
void advice_free(struct advice_list *a);

/* Logs the advice as warnings before a run. Jobs whose input files take long to read are skipped; `hoodoo check` handles them.
 * Errors in the job are left for the run itself to find and report. `run_follows`: in this process; it
 * logs the volumes of input files itself. E_MEMORY. */
MUST_USE status advice_log(const struct job *job, bool run_follows);

#endif
