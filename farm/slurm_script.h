/* The batch script of a Slurm job: it runs one hoodoo command of a batch, passes on the signals that Slurm sends to batch
 * scripts, and requeues its job when the command stopped after saving or failed and may be tried again. */
#ifndef HOODOO_FARM_SLURM_SCRIPT_H
#define HOODOO_FARM_SLURM_SCRIPT_H

#include "farm/farm.h"
#include "text/text.h"

/* `task`: the first of n tasks of one kind; the script chooses by SLURM_ARRAY_TASK_ID. `device`: for --device. */
MUST_USE status slurm_script(const struct farm *f, const struct farm_task *task, size_t n, const char *device,
                             struct text *out);

#endif
