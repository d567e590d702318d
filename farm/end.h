/* The end of a job: `hoodoo status OUT --end`, the task that runs when all others have ended.
 *
 * It calls farm.on_done and leaves OUT/farm/end.json: {"format": 1, "state": "done" or "failed", "tasks": N, "tasks_done": N}. The
 * file is created before the program is started and only by one process, so that the program is never run twice for one end:
 * once when all tasks are done, and once for each submission that ends with tasks missing. If the machine dies while the program runs, the
 * program is not run again.
 *
 * The program   is started without a shell, in the output folder, with HOODOO_OUT, HOODOO_NAME, HOODOO_STATE (done or failed),
 *               HOODOO_TASKS and HOODOO_TASKS_DONE in its environment. What it writes goes to log/farm/on_done.log.
 */
#ifndef HOODOO_FARM_END_H
#define HOODOO_FARM_END_H

#include "farm/farm.h"

/* Counts what is done, and runs the program unless it was run for this end. E_OUTPUT: tasks are not done (the message names the
 * first), or the program failed. */
MUST_USE status farm_end(const char *root);

/* Before a submission: forgets an end that failed. */
void farm_end_reset(const struct farm *f);

#endif
