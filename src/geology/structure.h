/* The structure of the rock as a function of position in metres, the job and its seed only.
 *
 * Beds, cross-bedding, joints, breccia and concretions multiply the properties of the stratum. See README.md in this folder.
 */
#ifndef HOODOO_STRUCTURE_H
#define HOODOO_STRUCTURE_H

#include "base/status.h"
#include "geology/beds.h"
#include "geology/joints.h"
#include "job/job.h"

struct structure {
    const struct job *job;
    bool plain; /* all factors are 1 */
    struct beds beds;
    struct joints joints;
};

/* The structure of the job's domain. The job must outlive *out. Free with structure_destroy(). E_USAGE: there are too many beds or joints. */
MUST_USE status structure_create(const struct job *job, struct structure *out);
void structure_destroy(struct structure *s);

/* Means over a cube of width h around x: the factors on rates and on interlocking thresholds; and the ratio of a front's speed along the beds
 * to that across them, 1 or more. */
struct structure_rock {
    double rate, interlock, along;
};
struct structure_rock structure_at(const struct structure *s, const double x[3], double h);

#endif
