/* The graph in an answer (base/text.h's JSON): what plan and submit --dry-run print. */
#ifndef HOODOO_FARM_DESCRIBE_H
#define HOODOO_FARM_DESCRIBE_H

#include "base/text.h"
#include "farm/farm.h"

/* Members "wedges" (if there are any) and "tasks" of the object under way. `words`: flat rows, and no more of them than a person
 * reads. Otherwise each has all that a farm needs to run it: its command as a list, what it waits for, what it takes, where it
 * logs. `device`: for --device, or NULL. E_USAGE: a command is too long. */
MUST_USE status farm_describe(const struct farm *f, bool words, const char *device, struct text *out);

#endif
