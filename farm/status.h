/* How far a submitted job is: its files, joined with what the tasks and the scheduler report. */
#ifndef HOODOO_FARM_STATUS_H
#define HOODOO_FARM_STATUS_H

#include <stdbool.h>

#include "text/text.h"

/* Whether `root` was made by hoodoo submit. */
bool farm_is(const char *root);
/* Whether it was, and holds wedges, whose frames are in folders of their own. */
MUST_USE status farm_has_wedges(const char *root, bool *yes);

/* Adds members "wedges" (if there are any), "tasks" (those that are not done), "tasks_done" and "task_count" to the open JSON
 * object. Each task has its state; where it has started, its tries, last exit code with its meaning, node and elapsed time; the nodes
 * that it avoids; its Slurm job and the reason for which that waits; its log. `words`: for people, with fewer columns. If squeue cannot be
 * asked, a warning says so. */
MUST_USE status farm_status(const char *root, bool words, struct text *out);

#endif
