/* Generated joints: their planes, their effect on the rock beside them, and which rock they separate.
 *
 * Joint j of a set is a plane with the set's dip at u_j = n . x. Distances between neighbours are lognormal; the strike of each differs from
 * the set's by a normally distributed angle, about the pivot of the job's attitude. Patches of a plane, length_m wide and high, are open
 * with the probability `persistence`. The numbers are hashed from the seed and j, so that no joint depends on the domain.
 *
 * Rock is weakened within half of weakened_m to either side. A zone thinner than a voxel acts by its share of the voxel along the joint's
 * normal: on rates like sheets that lead a front (lead.h), on all else by the mean.
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
    double at;            /* m: position along the set's normal through the pivot */
    double normal[3], on; /* its plane: normal . x = on */
    int64_t index;        /* in its set */
};

struct joint_plan {
    const struct job_joint_set *job;
    uint32_t seed;
    double normal[3];   /* of the set */
    double along[3];    /* level, within its planes */
    double reach;       /* m: largest distance of a joint from its `at` within the domain */
    size_t n, capacity; /* joints that may cross the domain, ascending by `at` */
    struct joint *joint;
};

struct joints {
    const struct job *job;
    size_t n;
    struct joint_plan *set;
};

/* The joints that may cross a domain from `low` to `high`. The job must outlive *out. Free with joints_destroy(). E_USAGE: there are more
 * than a job may have. E_MEMORY. */
MUST_USE status joints_create(const struct job *job, const double low[3], const double high[3],
                              struct joints *out);
void joints_destroy(struct joints *j);

/* The factors of weakened zones on rates, interlocking thresholds and stiffness in a cube of width h around x, where s is `height`. The
 * stiffness is the mean, for joints are steep and carry load in parallel with the rock beside them. */
struct joint_effect {
    double rate, interlock, stiffness;
};
struct joint_effect joints_at(const struct joints *j, const double x[3], double height, double h);

/* Does any set reduce the stiffness? */
bool joints_soften(const struct job *job);

/* Does any set separate blocks? And is an open patch of such a joint between two points that are level neighbours? */
bool joints_part(const struct job *job);
bool joints_between(const struct joints *j, const double a[3], const double b[3]);

#endif
