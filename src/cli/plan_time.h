/* Estimates the time of a plan by a rehearsal. */
#ifndef HOODOO_CLI_PLAN_TIME_H
#define HOODOO_CLI_PLAN_TIME_H

#include "cli/options.h"
#include "farm/farm.h"
#include "run/rehearsal.h"

/* The arguments of the plan, as farm_load() takes them. */
struct plan_asked {
    const char *path;
    const struct common *common;
    double patience; /* approximate limit for rehearsals, s; 0: no rehearsal */
};

struct plan_time {
    struct cost job; /* all frames of the farm's first wedge; 0: unknown */
    char from[160];  /* the basis of the estimate, as text */
};

/* Rehearses the first wedge at its own spacing or, if that would exceed the time limit or the memory, at two coarser spacings from
 * which the cost is extrapolated. An error is one of the job's own first frames. */
MUST_USE status plan_rehearse(const struct plan_asked *asked, struct gpu *gpu, const struct farm *f,
                              struct plan_time *out);

#endif
