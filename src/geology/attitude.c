#include "geology/attitude.h"

#include <math.h>

#include "base/vector.h"
#include "geology/lead.h"

static double radians(double degrees)
{
    return degrees * (M_PI / 180);
}

bool attitude_is_level(const struct job *job)
{
    const struct job_attitude *a = &job->attitude;
    return a->dip_deg == 0 && a->n_folds == 0 && a->n_faults == 0 && a->n_unconformities == 0;
}

void attitude_normal(double strike_deg, double dip_deg, double normal[3])
{
    const double strike = radians(strike_deg), dip = radians(dip_deg);
    normal[0] = sin(dip) * sin(strike);
    normal[1] = -sin(dip) * cos(strike);
    normal[2] = dip_deg == 90 ? 0 : cos(dip);
}

/* The height of x above a fault's plane, m. `down`: the slip of the rock above it, per metre of throw. */
static double above_fault(const struct job_fault *fault, const double x[3], double down[3])
{
    double normal[3];
    attitude_normal(fault->strike_deg, fault->dip_deg, normal);
    const double level = hypot(normal[0], normal[1]);
    for (int i = 0; i < 2; i++)
        down[i] = normal[i] / level * (normal[2] / level);
    down[2] = -1;
    const double d[3] = {x[0] - fault->point_m[0], x[1] - fault->point_m[1], x[2] - fault->point_m[2]};
    return dot3(normal, d);
}

/* The height s of a position, d from the pivot, that is at `height` in the beds above an unconformity. Below it the older beds continue with
 * their own attitude; what would be above it has been eroded. */
static double below(const struct job_unconformity *u, const double d[3], double height, double slope[3])
{
    const double dip = radians(u->dip_deg), azimuth = radians(u->dip_azimuth_deg);
    const double across[3] = {cos(azimuth), sin(azimuth), 0};
    if (height >= u->at_m)
        return height;
    for (int i = 0; i < 3; i++)
        slope[i] = cos(dip) * slope[i] + sin(dip) * across[i];
    const double older = u->at_m - u->eroded_m + cos(dip) * (height - u->at_m) + sin(dip) * dot3(across, d);
    return fmin(older, nextafter(u->at_m, -INFINITY));
}

void attitude_up(const struct job *job, double out[3])
{
    const double dip = radians(job->attitude.dip_deg), azimuth = radians(job->attitude.dip_azimuth_deg);
    out[0] = sin(dip) * cos(azimuth);
    out[1] = sin(dip) * sin(azimuth);
    out[2] = cos(dip);
}

double attitude_height(const struct job *job, const double x[3], double gradient[3])
{
    const struct job_attitude *a = &job->attitude;
    const double *pivot = a->pivot_m;
    double at[3] = {x[0], x[1], x[2]}, slope[3] = {0, 0, 1};
    if (attitude_is_level(job)) {
        for (int i = 0; gradient && i < 3; i++)
            gradient[i] = slope[i];
        return x[2];
    }
    for (size_t f = a->n_faults; f-- > 0;) {
        double down[3];
        if (above_fault(&a->faults[f], at, down) > 0)
            for (int i = 0; i < 3; i++)
                at[i] -= a->faults[f].throw_m * down[i];
    }
    attitude_up(job, slope);
    const double d[3] = {at[0] - pivot[0], at[1] - pivot[1], at[2] - pivot[2]};
    double height = pivot[2] + dot3(slope, d);
    for (size_t f = 0; f < a->n_folds; f++) {
        const struct job_fold *fold = &a->folds[f];
        const double axis = radians(fold->axis_deg), wave = 2 * M_PI / fold->wavelength_m;
        const double across[2] = {-sin(axis), cos(axis)};
        const double turn = wave * (across[0] * d[0] + across[1] * d[1]) + radians(fold->phase_deg);
        height -= fold->amplitude_m * sin(turn);
        for (int i = 0; i < 2; i++)
            slope[i] -= fold->amplitude_m * wave * cos(turn) * across[i];
    }
    for (size_t u = a->n_unconformities; u-- > 0;)
        height = below(&a->unconformities[u], d, height, slope);
    for (int i = 0; gradient && i < 3; i++)
        gradient[i] = slope[i];
    return height;
}

size_t attitude_layer(const struct job *job, const double x[3])
{
    return job_layer_at(job, attitude_height(job, x, NULL));
}

double attitude_share(double from, double wide, double h)
{
    const double low = fmax(from - wide / 2, -h / 2), high = fmin(from + wide / 2, h / 2);
    return high > low ? (high - low) / h : 0;
}

double attitude_breccia(const struct job *job, const double x[3], double h)
{
    const struct job_attitude *a = &job->attitude;
    double factor = 1, at[3] = {x[0], x[1], x[2]};
    for (size_t f = a->n_faults; f-- > 0;) {
        const struct job_fault *fault = &a->faults[f];
        double down[3];
        const double above = above_fault(fault, at, down);
        factor *= lead_mean(fault->breccia, attitude_share(above, fault->breccia_m, h));
        for (int i = 0; above > 0 && i < 3; i++)
            at[i] -= fault->throw_m * down[i];
    }
    return factor;
}
