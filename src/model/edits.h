/* Applying a frame's edits. */
#ifndef HOODOO_EDITS_H
#define HOODOO_EDITS_H

#include <stdbool.h>

#include "job/job.h"
#include "particles/frame.h"
#include "particles/rock.h"

enum edits_kind { EDITS_NONE, EDITS_SET, EDITS_ROCK };

/* What the edits of this frame change: nothing, only keys (see job_at()), or also the rock. */
enum edits_kind edits_of(const struct job *job, int frame);

/* Whether `wanted` holds for the job or for the job after one of its edits. */
bool edits_ever(const struct job *job, bool (*wanted)(const struct job *));

/* Whether any edit paints plants. */
bool edits_plant(const struct job *job);

/* Carves, adds and paints in the order of the list. The arrays of the rock's STATE fields are replaced. Added particles are added to the
 * ledger's `start` and to *start_volume (m3), carved ones to `left`; the caller recounts rock and deposits. E_USAGE, E_INPUT: a shape or
 * a file is wrong. */
MUST_USE status edits_apply(const struct job *job, int frame, struct rock *rock, struct ledger *ledger,
                            double *start_volume);

#endif
