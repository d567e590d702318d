/* A plan's time: rehearsed. */
#ifndef HOODOO_CLI_PLAN_TIME_H
#define HOODOO_CLI_PLAN_TIME_H

#include "cli/options.h"
#include "farm/farm.h"
#include "run/rehearsal.h"

/* What the plan was asked for: farm_load()'s words. */
struct plan_asked {
    const char *path;
    const struct common *common;
    double patience; /* s that rehearsals may take, about; 0: none is wanted */
};

struct plan_time {
    struct cost job; /* all frames of the farm's first wedge; 0: not known */
    char from[160];  /* what it rests on, in words */
};

/* Rehearses the first wedge at its own spacing, or, where that would take more than patience or memory, at two coarser ones, from which it
 * is drawn out. E_*: what the job's own first frames end with. */
MUST_USE status plan_rehearse(const struct plan_asked *asked, struct gpu *gpu, const struct farm *f,
                              struct plan_time *out);

#endif
