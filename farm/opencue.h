/* OpenCue back end: an outline, a Python script that `pycuerun OUT/NAME.outline` submits.
 *
 *     OUT/NAME.outline      makes a layer for each block, and for the tasks of a kind that wait for the same
 *     OUT/farm/tasks.json   the tasks, which the script reads: the same as submit --to tasks prints (describe.h)
 */
#ifndef HOODOO_FARM_OPENCUE_H
#define HOODOO_FARM_OPENCUE_H

#include "farm/farm.h"
#include "text/text.h"

/* The script, which reads `tasks`, the path of the tasks as JSON. */
MUST_USE status opencue_outline(const struct farm *f, const char *tasks, struct text *out);

#endif
