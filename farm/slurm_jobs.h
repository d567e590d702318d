/* The Slurm jobs of a farm's tasks: farm/slurm.json, joined with squeue. */
#ifndef HOODOO_FARM_SLURM_JOBS_H
#define HOODOO_FARM_SLURM_JOBS_H

#include "farm/farm.h"

/* Seconds to wait for an answer: a busy controller is slow, a hanging one never answers. */
enum { SLURM_ANSWER_S = 600 };

enum { SLURM_ID = 64 };

/* A job as squeue shows it. */
struct slurm_job {
    char id[SLURM_ID], state[32], reason[64], node[128], elapsed[32];
};

/* For each task of the graph, its last Slurm job; `state` is "" if Slurm no longer knows the job. squeue is asked for these jobs only.
 * *out is freed with free(); NULL if the folder was never submitted to Slurm. E_INPUT: slurm.json is damaged, or squeue fails. */
MUST_USE status slurm_jobs(const struct farm *f, struct slurm_job **out);

/* Sets job[task] for the tasks whose jobs wait or run. */
MUST_USE status slurm_active(const struct farm *f, char (*job)[SLURM_ID]);

/* Cancels n jobs; "" is no job. E_INPUT: scancel is not installed. E_OUTPUT: it failed. */
MUST_USE status slurm_cancel(const char (*job)[SLURM_ID], size_t n);

/* Writes farm/slurm.json: job[task], or where that is "", the id that the file had before. */
MUST_USE status slurm_remember(const struct farm *f, char (*job)[SLURM_ID]);

#endif
