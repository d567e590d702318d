/* The graph of tasks as JSON: what hoodoo plan, submit --dry-run and submit --to tasks print. farm/README.md documents its members. */
#ifndef HOODOO_FARM_DESCRIBE_H
#define HOODOO_FARM_DESCRIBE_H

#include "farm/farm.h"
#include "text/text.h"

/* Adds members "wedges" (if there are any) and "tasks" to the open JSON object. `words`: for people, flat rows and at most 100 of
 * them. Otherwise each task has all that a farm needs to run it. `device`: for --device, or NULL. E_USAGE: a command is too long. */
MUST_USE status farm_describe(const struct farm *f, bool words, const char *device, struct text *out);

#endif
