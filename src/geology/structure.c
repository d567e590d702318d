#include "geology/structure.h"

#include <math.h>

#include "base/vector.h"
#include "geology/attitude.h"
#include "geology/concretions.h"

/* Bounds of the height s in the domain. */
static void heights(const struct job *job, double *low, double *high)
{
    struct job level = *job;
    double moved = 0;
    level.attitude.n_faults = level.attitude.n_folds = level.attitude.n_unconformities = 0;
    *low = INFINITY;
    *high = -INFINITY;
    for (int corner = 0; corner < 8; corner++) {
        double x[3];
        for (int a = 0; a < 3; a++)
            x[a] = corner >> a & 1 ? job->domain.size_m[a] : 0;
        const double height = attitude_height(&level, x, NULL);
        *low = fmin(*low, height);
        *high = fmax(*high, height);
    }
    for (size_t i = 0; i < job->attitude.n_folds; i++)
        moved += job->attitude.folds[i].amplitude_m;
    for (size_t i = 0; i < job->attitude.n_faults; i++) {
        const struct job_fault *f = &job->attitude.faults[i];
        moved += fabs(f->throw_m) / sin(f->dip_deg * (M_PI / 180));
    }
    for (size_t i = 0; i < job->attitude.n_unconformities; i++) {
        const double *pivot = job->attitude.pivot_m;
        double far = 0;
        for (int a = 0; a < 2; a++)
            far += fmax(fabs(pivot[a]), fabs(job->domain.size_m[a] - pivot[a]));
        moved += job->attitude.unconformities[i].eroded_m + far + (*high - *low) +
                 fabs(job->attitude.unconformities[i].at_m - *low);
    }
    moved += 2 * job->domain.spacing_m;
    *low -= moved;
    *high += moved;
}

status structure_create(const struct job *job, struct structure *s)
{
    status st = OK;
    static const double origin[3];
    double low, high, end[3];
    *s = (struct structure){.job = job,
                            .plain = !job->n_strata_from && !job->n_joints && !job->attitude.n_faults &&
                                     !job->n_concretions};
    if (s->plain)
        return OK;
    for (size_t i = 0; i < job->n_concretions; i++) {
        double count;
        const double side = concretions_cube(&job->concretions[i], &count);
        if (count > CONCRETIONS_MAX)
            return fail(
                E_USAGE,
                "concretions.%zu: %.3g lie in each cube of %.3g m, which the largest fill: %d at most; lower per_m3 (%g), radius_m (%g) or spread (%g)",
                i, count, side, (int)CONCRETIONS_MAX, job->concretions[i].per_m3,
                job->concretions[i].radius_m, job->concretions[i].spread);
    }
    heights(job, &low, &high);
    for (int a = 0; a < 3; a++)
        end[a] = job->domain.size_m[a] + 2 * job->domain.spacing_m; /* the last voxels may extend beyond it */
    TRY(beds_create(job, low, high, &s->beds));
    TRY(joints_create(job, origin, end, &s->joints));
done:
    if (st != OK)
        structure_destroy(s);
    return st;
}

void structure_destroy(struct structure *s)
{
    beds_destroy(&s->beds);
    joints_destroy(&s->joints);
}

struct structure_rock structure_at(const struct structure *s, const double x[3], double h)
{
    double gradient[3], along;
    if (s->plain)
        return (struct structure_rock){1, 1, 1};
    const double height = attitude_height(s->job, x, gradient);
    const double deep = h * sqrt(dot3(gradient, gradient));
    const double hardness = beds_hardness(&s->beds, height - deep / 2, height + deep / 2, &along);
    const struct joint_effect joints = joints_at(&s->joints, x, height, h);
    return (struct structure_rock){
        .rate = beds_cross(s->job, x, height, h) * attitude_breccia(s->job, x, h) * joints.rate /
                (hardness * concretions_hardness(s->job, x, height, h)),
        .interlock = joints.interlock,
        .along = fmax(hardness / along, 1),
    };
}
