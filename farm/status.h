/* How far a farm's folder is: its files, joined with what the scheduler says. */
#ifndef HOODOO_FARM_STATUS_H
#define HOODOO_FARM_STATUS_H

#include <stdbool.h>

#include "base/text.h"

/* Was `root` made by submit? */
bool farm_is(const char *root);
/* ... and has it wedges, so that its frames are in folders of their own? */
MUST_USE status farm_has_wedges(const char *root, bool *yes);

/* Members "wedges" (where there are), "tasks_done", "task_count" and "tasks" (those that are not done) of the
 * JSON object under way. Without Slurm's word, when squeue cannot be asked, it says why and goes on. */
MUST_USE status farm_status(const char *root, struct text *out);

#endif
