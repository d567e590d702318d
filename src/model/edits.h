/* A frame's edits, as models apply them. */
#ifndef HOODOO_EDITS_H
#define HOODOO_EDITS_H

#include <stdbool.h>

#include "job/job.h"
#include "particles/frame.h"
#include "particles/rock.h"

enum edits_kind { EDITS_NONE, EDITS_SET, EDITS_ROCK };

/* What the edits of this frame change: nothing, parameters (job_at() has them), or also the rock. */
enum edits_kind edits_of(const struct job *job, int frame);

/* Does any edit paint plants? */
bool edits_plant(const struct job *job);

/* Carves, adds and paints, in the list's order, on the rock's STATE fields, whose arrays are replaced. What is
 * added counts as start in the ledger, and in *start_volume (m3); what is carved as left; what there is then of rock
 * and deposits is the caller's to count. E_USAGE, E_INPUT: a shape or a file is wrong. */
MUST_USE status edits_apply(const struct job *job, int frame, struct rock *rock, struct ledger *ledger,
                            double *start_volume);

#endif
