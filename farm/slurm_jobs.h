/* Which task is which Slurm job: farm/slurm.json, joined with squeue. */
#ifndef HOODOO_FARM_SLURM_JOBS_H
#define HOODOO_FARM_SLURM_JOBS_H

#include "farm/farm.h"

/* s: a busy controller answers late, one that hangs never. */
enum { SLURM_ANSWER_S = 600 };

enum { SLURM_ID = 64 };

/* A job as squeue shows it. */
struct slurm_job {
    char id[SLURM_ID], state[32], reason[64];
};

/* Per task of the graph: what was submitted for it last, and "" for state where Slurm knows it no more. *out
 * is freed with free(); NULL if the folder was never submitted to Slurm. E_INPUT: slurm.json is damaged, or
 * squeue cannot tell. */
MUST_USE status slurm_jobs(const struct farm *f, struct slurm_job **out);

/* Sets job[task] for the tasks whose jobs wait or run. */
MUST_USE status slurm_active(const struct farm *f, char (*job)[SLURM_ID]);

/* Writes farm/slurm.json: job[task], and for those without one what was there before. */
MUST_USE status slurm_remember(const struct farm *f, char (*job)[SLURM_ID]);

#endif
