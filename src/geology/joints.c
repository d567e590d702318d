#include "geology/joints.h"

#include <math.h>
#include <stdlib.h>

#include "base/memory.h"
#include "base/vector.h"
#include "geology/attitude.h"
#include "geology/chance.h"
#include "geology/lead.h"

/* The purposes of a joint's random numbers. */
enum { SPACING, TURN, PHASE, PATCH };

enum { MOST_JOINTS = 2000000 };

/* Flatter joints are kept closed by the load on them. */
static const double steep_deg = 60;

/* Strikes are limited to so many standard deviations. */
static const double most_turned = 2.5;

/* ---- positions */

static double spacing_of(const struct joint_plan *s, int64_t i)
{
    const double spread = s->job->spread;
    return s->job->spacing_m * exp(spread * chance_normal(s->seed, i, 0, SPACING) - spread * spread / 2);
}

static status add(struct joint_plan *s, const double pivot[3], int64_t index, double at)
{
    status st = OK;
    const double turn = fmin(fmax(chance_normal(s->seed, index, 0, TURN), -most_turned), most_turned);
    TRY(memory_grow(&s->joint, &s->capacity, s->n + 1, sizeof *s->joint, "joints"));
    struct joint *j = &s->joint[s->n++];
    *j = (struct joint){.at = at, .index = index};
    attitude_normal(s->job->strike_deg + turn * s->job->jitter_deg, s->job->dip_deg, j->normal);
    /* The plane passes through the same point of the pivot's normal as the set's own plane. */
    for (int a = 0; a < 3; a++)
        j->on += j->normal[a] * (pivot[a] + s->normal[a] * (at - dot3(s->normal, pivot)));
done:
    return st;
}

static status find(struct joint_plan *s, const double pivot[3], double low, double high)
{
    status st = OK;
    int64_t i = 0;
    double at = s->job->spacing_m * chance(s->seed, 0, 0, PHASE);
    while (at > low && i > -MOST_JOINTS)
        at -= spacing_of(s, i--);
    while (at < high) {
        if (i > MOST_JOINTS || i == -MOST_JOINTS)
            return fail(E_USAGE,
                        "joints: more than %d joints %g m apart lie between the origin and the domain",
                        (int)MOST_JOINTS, s->job->spacing_m);
        if (at >= low)
            TRY(add(s, pivot, i, at));
        at += spacing_of(s, ++i);
    }
done:
    return st;
}

status joints_create(const struct job *job, const double low[3], const double high[3], struct joints *j)
{
    status st = OK;
    const double diagonal = hypot(hypot(high[0] - low[0], high[1] - low[1]), high[2] - low[2]);
    *j = (struct joints){.job = job};
    const double *pivot = job->attitude.pivot_m;
    TRY(memory_alloc(job->n_joints, sizeof *j->set, "joints", &j->set));
    for (; j->n < job->n_joints; j->n++) {
        struct joint_plan *s = &j->set[j->n];
        s->job = &job->joints[j->n];
        s->seed = chance_seed(job->seed, s->job->seed, (uint32_t)j->n, RANDOM_JOINTS);
        attitude_normal(s->job->strike_deg, s->job->dip_deg, s->normal);
        const double strike = s->job->strike_deg * (M_PI / 180);
        s->along[0] = cos(strike);
        s->along[1] = sin(strike);
        double far = 0, first = 0, last = 0;
        for (int a = 0; a < 3; a++) {
            const double ends[2] = {s->normal[a] * low[a], s->normal[a] * high[a]};
            first += fmin(ends[0], ends[1]);
            last += fmax(ends[0], ends[1]);
            far += pow(fmax(fabs(low[a] - pivot[a]), fabs(high[a] - pivot[a])), 2);
        }
        /* Rotating a plane by an angle moves it by at most the sine times the distance from the pivot. */
        const double turned = sin(fmin(most_turned * s->job->jitter_deg, 90) * (M_PI / 180));
        s->reach = turned * (sqrt(far) + diagonal) + s->job->weakened_m / 2 + job->domain.spacing_m;
        TRY(find(s, pivot, first - s->reach, last + s->reach));
    }
done:
    if (st != OK)
        joints_destroy(j);
    return st;
}

void joints_destroy(struct joints *j)
{
    for (size_t i = 0; j->set && i < j->n; i++)
        free(j->set[i].joint);
    free(j->set);
    *j = (struct joints){0};
}

/* The index of the set's first joint at or above `at`. */
static size_t first_from(const struct joint_plan *s, double at)
{
    size_t low = 0, high = s->n;
    while (low < high) {
        const size_t middle = (low + high) / 2;
        if (s->joint[middle].at < at)
            low = middle + 1;
        else
            high = middle;
    }
    return low;
}

/* Is the patch of the joint at x open? */
static bool parted(const struct joint_plan *s, const struct joint *j, const double x[3])
{
    if (s->job->persistence >= 1)
        return true;
    const double length = s->job->length_m;
    const double along = dot3(s->along, x) / length + chance(s->seed, j->index, 0, PHASE + 10);
    const double up = x[2] / length + chance(s->seed, j->index, 1, PHASE + 10);
    const uint32_t patch = random_hash(s->seed, (uint32_t)j->index, PATCH, 0);
    return chance(patch, (int64_t)floor(along), (int64_t)floor(up), PATCH) < s->job->persistence;
}

/* ---- effects */

struct joint_effect joints_at(const struct joints *all, const double x[3], double height, double h)
{
    struct joint_effect out = {1, 1, 1};
    for (size_t i = 0; i < all->n; i++) {
        const struct joint_plan *s = &all->set[i];
        const double at = dot3(s->normal, x), reach = s->reach;
        double share = 0;
        if (height < s->job->from_m || height >= s->job->to_m || !(s->job->persistence > 0))
            continue;
        for (size_t k = first_from(s, at - reach); share < 1 && k < s->n && s->joint[k].at <= at + reach;
             k++) {
            const struct joint *j = &s->joint[k];
            const double own = attitude_share(dot3(j->normal, x) - j->on, s->job->weakened_m, h);
            if (own > 0 && parted(s, j, x))
                share += own;
        }
        share = fmin(share, 1);
        out.rate *= lead_mean(s->job->rate, share);
        out.interlock *= 1 + (s->job->interlock - 1) * share;
        out.stiffness *= 1 + (s->job->stiffness - 1) * share;
    }
    return out;
}

bool joints_soften(const struct job *job)
{
    bool any = false;
    for (size_t i = 0; i < job->n_joints; i++)
        any |= job->joints[i].stiffness < 1 && job->joints[i].weakened_m > 0;
    return any;
}

static bool parts(const struct job_joint_set *s)
{
    return s->blocks && s->dip_deg >= steep_deg && s->persistence > 0;
}

bool joints_part(const struct job *job)
{
    bool any = false;
    for (size_t i = 0; i < job->n_joints; i++)
        any |= parts(&job->joints[i]);
    return any;
}

bool joints_between(const struct joints *all, const double a[3], const double b[3])
{
    const double x[3] = {(a[0] + b[0]) / 2, (a[1] + b[1]) / 2, (a[2] + b[2]) / 2};
    for (size_t i = 0; i < all->n; i++) {
        const struct joint_plan *s = &all->set[i];
        const double at = dot3(s->normal, x), reach = s->reach;
        if (!parts(s->job))
            continue;
        const double height = attitude_height(all->job, x, NULL);
        if (height < s->job->from_m || height >= s->job->to_m)
            continue;
        for (size_t k = first_from(s, at - reach); k < s->n && s->joint[k].at <= at + reach; k++) {
            const struct joint *j = &s->joint[k];
            if ((dot3(j->normal, a) < j->on) != (dot3(j->normal, b) < j->on) && parted(s, j, x))
                return true;
        }
    }
    return false;
}
