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

/* Sets frame_seconds of each wedge: from the frames in its folder; else, for the first wedge, from a rehearsal, if `gpu` is not NULL and
 * patience allows it; other wedges take time in proportion to their particles. 0 where nothing is known. The rehearsal is at the wedge's own
 * spacing, or, where that would take more than patience or memory, at two coarser ones, from which it is extrapolated.
 * E_*: the error that the job's own first frames end with. */
MUST_USE status plan_frame_times(const struct plan_asked *asked, struct gpu *gpu, struct farm *f,
                                 struct plan_time *out);

#endif
