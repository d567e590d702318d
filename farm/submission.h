/* Where and how a job was submitted: OUT/farm/submission.json. `hoodoo retry` submits the same way again, `hoodoo cancel` finds
 * what to stop. */
#ifndef HOODOO_FARM_SUBMISSION_H
#define HOODOO_FARM_SUBMISSION_H

#include <stddef.h>

#include "base/choice.h"
#include "base/status.h"
#include "system/process.h"

#define SUBMIT_TO_CHOICE                                                                                     \
    (TO_LOCAL, "local")(TO_SLURM, "slurm")(TO_OPENJD, "openjd")(TO_DEADLINE, "deadline")(                    \
        TO_OPENCUE, "opencue")(TO_TASKS, "tasks")
enum { CHOICE_CONSTANTS(SUBMIT_TO_CHOICE) };

enum { SUBMISSION_EXTRA = 64 };

struct submission {
    int to;                    /* TO_*, or -1: unknown, as of a folder that an older hoodoo submitted */
    int wedge, workers;        /* --wedge, --workers; 0: not given */
    const char *device, *gpus; /* --device, --gpus, or NULL */
    const char *extra[SUBMISSION_EXTRA]; /* more arguments for sbatch */
    size_t n_extra;
    struct process_id process; /* TO_LOCAL: that hands the tasks to workers; pid 0: none */
    struct json *json;         /* owns the texts of a submission that was read */
};

/* E_USAGE: too many arguments for sbatch. */
MUST_USE status submission_write(const char *root, const struct submission *s);

/* E_INPUT: the file is damaged. A missing file gives to = -1. Freed with submission_free(). */
MUST_USE status submission_read(const char *root, struct submission *out);
void submission_free(struct submission *s);

/* "local", "slurm" ... */
const char *submission_name(int to);

#endif
