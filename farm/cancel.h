/* Stops a submitted job: hoodoo cancel OUT. What is done stays, and hoodoo retry OUT continues. */
#ifndef HOODOO_FARM_CANCEL_H
#define HOODOO_FARM_CANCEL_H

#include "farm/farm.h"
#include "text/text.h"

/* Slurm: cancels the tasks' jobs, and no others. Local: sends SIGTERM to the submitting process, which has its tasks save and exits
 * with 85, and waits for it. Adds members "to" and "cancelled" (a list of tasks) to the open JSON object. farm.on_done is not
 * run. E_USAGE: the tasks are with another scheduler, or with a process on another machine; E_OUTPUT: the process does not end. */
MUST_USE status farm_cancel(const struct farm *f, struct text *out);

#endif
