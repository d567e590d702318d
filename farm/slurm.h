/* Slurm back end: a batch job for each block, chained by afterok; an array for the meshes, AOVs, stills or views of a block; and a job
 * that ends the others, after any outcome (afterany), which also gets the user's mail options: one mail for the whole job.
 *
 * Each job has its own script in farm/slurm/ (slurm_script.h). The site needs nothing but GPUs as gres; it may have RequeueExit=85 or not.
 * farm/slurm.json records what was submitted.
 */
#ifndef HOODOO_FARM_SLURM_H
#define HOODOO_FARM_SLURM_H

#include "farm/farm.h"
#include "text/text.h"

struct slurm_options {
    const char *device;       /* for --device; NULL: slurm */
    const char *const *extra; /* more arguments for every sbatch: --partition=gpu */
    size_t n_extra;
    bool dry_run; /* describe what would be submitted in *out; write and submit nothing */
};

/* Submits the chosen tasks that are neither done nor queued. E_OUTPUT with sbatch's message if it refuses. Adds members
 * "submitted" (or "would_submit"), "done_already" and "queued_already" to the open JSON object in *out. */
MUST_USE status slurm_submit(const struct farm *f, const struct slurm_options *options, struct text *out);

#endif
