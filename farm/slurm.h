/* The farm that is Slurm: a batch job per block, chained by afterok; an array per set of meshes and of stills.
 *
 * Each job is a script of its own under farm/slurm/, which runs one hoodoo command, passes the signals on
 * that Slurm gives to batch scripts, and queues itself again when the command was stopped after saving, or
 * failed and may be tried again. It needs nothing of the site but GPUs as gres, and works with RequeueExit=85
 * as without. What was submitted stands in farm/slurm.json.
 */
#ifndef HOODOO_FARM_SLURM_H
#define HOODOO_FARM_SLURM_H

#include "base/text.h"
#include "farm/farm.h"

struct slurm_options {
    const char *device;       /* for --device; NULL: slurm */
    const char *const *extra; /* more words for every sbatch: --partition=gpu */
    size_t n_extra;
    bool dry_run; /* say what would be submitted (in *out), write and submit nothing */
};

/* Submits what is not done and not under way already. E_OUTPUT with what sbatch said if it refuses. Adds
 * members "submitted" (or "would_submit") and so on to the JSON object under way in *out. */
MUST_USE status slurm_submit(const struct farm *f, const struct slurm_options *options, struct text *out);

#endif
