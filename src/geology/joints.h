/* Joints that are made: where each lies, and what it does to the rock beside it and to what hangs together across it.
 *
 * Joint j of a set is a plane of the set's dip at u_j = n . x, whose distances to its neighbours are lognormal; its strike differs
 * from the set's by a normal angle, about the pivot of the job's attitude. Patches of each plane, length_m wide and high, are
 * parted or not, by persistence. The numbers are hashed from the seed and j, so that no joint depends on the domain.
 *
 * Rock is weakened within half of weakened_m to either side. What is thinner than a voxel acts by its share of it along the joint's
 * normal: on rates as sheets do that lead a front (lead.h), on all else in the mean.
 *
 * source   Rives et al., Joint spacing, J. Struct. Geol. 14, 1992 (lognormal); ISRM, Int. J. Rock Mech. 15, 1978 (the terms)
 */
#ifndef HOODOO_JOINTS_H
#define HOODOO_JOINTS_H

#include <stdbool.h>
#include <stddef.h>

#include "base/status.h"
#include "job/job.h"

struct joint {
    double at;            /* m: along the set's normal, where it passes the pivot's line */
    double normal[3], on; /* its plane: normal . x = on */
    int64_t index;        /* in its set */
};

struct joint_plan {
    const struct job_joint_set *job;
    uint32_t seed;
    double normal[3];   /* of the set */
    double along[3];    /* level, within its planes */
    double reach;       /* m: as far as a joint may be from its `at`, in the domain */
    size_t n, capacity; /* joints that the domain may meet, ascending by `at` */
    struct joint *joint;
};

struct joints {
    const struct job *job;
    size_t n;
    struct joint_plan *set;
};

/* Those that a domain from `low` to `high` meets. The job outlives it. E_USAGE: they would be more than a job may have. */
MUST_USE status joints_create(const struct job *job, const double low[3], const double high[3],
                              struct joints *out);
void joints_destroy(struct joints *j);

/* What a joint's weakening multiplies in a cube of the width h around x, where the pile's height is `height`: rates, interlocking
 * thresholds, and the stiffness, in the mean: joints are steep, and carry what lies on them beside the rock. */
struct joint_effect {
    double rate, interlock, stiffness;
};
struct joint_effect joints_at(const struct joints *j, const double x[3], double height, double h);

/* Whether any set softens rock. */
bool joints_soften(const struct job *job);

/* Whether any set parts blocks; and whether one of their joints passes between two places, beside each other on the level. */
bool joints_part(const struct job *job);
bool joints_between(const struct joints *j, const double a[3], const double b[3]);

#endif
