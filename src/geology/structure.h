/* The structure of the rock: what it is like at a place, a function of position in metres, the job and its seed alone.
 *
 * Beds, cross-bedding, joints and breccia multiply what the stratum at the place has. See README.md in this folder.
 */
#ifndef HOODOO_STRUCTURE_H
#define HOODOO_STRUCTURE_H

#include "base/status.h"
#include "geology/beds.h"
#include "geology/joints.h"
#include "job/job.h"

struct structure {
    const struct job *job;
    bool plain; /* 1 everywhere */
    struct beds beds;
    struct joints joints;
};

/* Of the job's domain. The job outlives it. E_USAGE: there would be too many beds or joints. */
MUST_USE status structure_create(const struct job *job, struct structure *out);
void structure_destroy(struct structure *s);

/* In the mean over a cube of the width h around x: what rates and interlocking thresholds are multiplied with; and how many times
 * faster a front runs along the beds than across them, 1 or more: the softest lead. */
struct structure_rock {
    double rate, interlock, along;
};
struct structure_rock structure_at(const struct structure *s, const double x[3], double h);

#endif
