#include "render/pile.h"

#include <math.h>
#include <stdio.h>

#include "base/vector.h"
#include "geology/attitude.h"

/* Declares Before_f_0, _1, _2: the coordinates of a place before the faults from the youngest to the f-th moved it. */
static void add_fault(const struct job *job, size_t f, struct text *out)
{
    const struct job_fault *fault = &job->attitude.faults[f];
    static const char *const own[3] = {"x", "y", "z"};
    char at[3][64];
    double normal[3], down[3] = {0, 0, -1};
    const bool youngest = f + 1 == job->attitude.n_faults;
    for (int i = 0; i < 3; i++) {
        if (youngest)
            snprintf(at[i], sizeof at[i], "%s", own[i]);
        else
            snprintf(at[i], sizeof at[i], "Before_%zu_%d(x, y, z)", f + 1, i);
    }
    attitude_normal(fault->strike_deg, fault->dip_deg, normal);
    double level = hypot(normal[0], normal[1]);
    for (int i = 0; i < 2; i++)
        down[i] = normal[i] / level * (normal[2] / level);
    text_add(out, "#declare Above_%zu = function(x, y, z) { %.9g * %s + %.9g * %s + %.9g * %s - %.9g }\n", f,
             normal[0], at[0], normal[1], at[1], normal[2], at[2], dot3(normal, fault->point_m));
    for (int i = 0; i < 3; i++)
        text_add(
            out,
            "#declare Before_%zu_%d = function(x, y, z) { %s - select(Above_%zu(x, y, z), 0, 0, %.9g) }\n", f,
            i, at[i], f, fault->throw_m * down[i]);
}

/* Declares Laid_u: the height in the pile of beds below the u-th unconformity, from that of the beds above it. */
static void add_unconformity(const struct job *job, size_t u, char at[3][32], struct text *out)
{
    const struct job_unconformity *old = &job->attitude.unconformities[u];
    const double *pivot = job->attitude.pivot_m, dip = old->dip_deg * M_PI / 180,
                 azimuth = old->dip_azimuth_deg * M_PI / 180;
    text_add(
        out,
        "#declare Laid_%zu = function(x, y, z) {\n    select(Laid_%zu(x, y, z) - %.9g, min(%.9g, %.9g + %.9g * (Laid_%zu(x, y, z) - %.9g) + %.9g * (%s - %.9g) + %.9g * (%s - %.9g)), Laid_%zu(x, y, z))\n}\n",
        u, u + 1, old->at_m, old->at_m - 1e-6 * fmax(fabs(old->at_m), 1), old->at_m - old->eroded_m, cos(dip),
        u + 1, old->at_m, sin(dip) * cos(azimuth), at[0], pivot[0], sin(dip) * sin(azimuth), at[1], pivot[1],
        u + 1);
}

/* The range of the pile inside the box: at its corners, extended by the crests of folds and by older beds. */
static void find_span(const struct job *job, double span[2])
{
    span[0] = INFINITY;
    span[1] = -INFINITY;
    for (int corner = 0; corner < 8; corner++) {
        double x[3];
        for (int i = 0; i < 3; i++)
            x[i] = corner >> i & 1 ? job->domain.size_m[i] : 0;
        double height = attitude_height(job, x, NULL);
        span[0] = fmin(span[0], height);
        span[1] = fmax(span[1], height);
    }
    for (size_t f = 0; f < job->attitude.n_folds; f++) {
        span[0] -= 2 * job->attitude.folds[f].amplitude_m;
        span[1] += 2 * job->attitude.folds[f].amplitude_m;
    }
    for (size_t u = 0; u < job->attitude.n_unconformities; u++)
        span[0] -= job->attitude.unconformities[u].eroded_m +
                   sin(job->attitude.unconformities[u].dip_deg * M_PI / 180) *
                       hypot(job->domain.size_m[0], job->domain.size_m[1]);
}

void pile_write(const struct job *job, struct text *out)
{
    const struct job_attitude *a = &job->attitude;
    double up[3], across[3], along[3], span[2];
    attitude_up(job, up);
    const double *pivot = job->attitude.pivot_m;
    find_span(job, span);
    text_add(out, "// ---- how beds lie\n#declare Bottom = %.9g;\n#declare Height = %.9g;\n", span[0] - 2,
             span[1] - span[0] + 4);
    if (attitude_is_level(job)) {
        text_add(out, "#declare Lie = transform { translate 0 }\n#declare Pile = function(x, y, z) { z }\n");
        return;
    }
    for (size_t f = a->n_faults; f-- > 0;)
        add_fault(job, f, out);
    char at[3][32] = {"x", "y", "z"};
    for (int i = 0; a->n_faults && i < 3; i++)
        snprintf(at[i], sizeof at[i], "Before_0_%d(x, y, z)", i);
    text_add(
        out,
        "#declare Laid_%zu = function(x, y, z) {\n    %.9g + %.9g * (%s - %.9g) + %.9g * (%s - %.9g) + %.9g * (%s - %.9g)",
        a->n_unconformities, pivot[2], up[0], at[0], pivot[0], up[1], at[1], pivot[1], up[2], at[2],
        pivot[2]);
    for (size_t f = 0; f < a->n_folds; f++) {
        const struct job_fold *fold = &a->folds[f];
        double axis = fold->axis_deg * M_PI / 180;
        text_add(out, "\n    - %.9g * sin(%.9g * (%.9g * (%s - %.9g) + %.9g * (%s - %.9g)) + %.9g)",
                 fold->amplitude_m, 2 * M_PI / fold->wavelength_m, -sin(axis), at[0], pivot[0], cos(axis),
                 at[1], pivot[1], fold->phase_deg * M_PI / 180);
    }
    text_add(out, "\n}\n");
    for (size_t u = a->n_unconformities; u-- > 0;)
        add_unconformity(job, u, at, out);
    text_add(out, "#declare Pile = function(x, y, z) { Laid_0(x, y, z) }\n");
    /* Axes of the tilted beds: the rows of the matrix are the images of x, y and z. */
    const double aside[3] = {fabs(up[0]) < 0.9, !(fabs(up[0]) < 0.9), 0};
    cross3(up, aside, across);
    double length = sqrt(dot3(across, across));
    for (int i = 0; i < 3; i++)
        across[i] /= length;
    cross3(across, up, along);
    text_add(out, "#declare Lie = transform {\n    translate <%.9g, %.9g, %.9g>\n    matrix <", -pivot[0],
             -pivot[1], -pivot[2]);
    const double *const row[3] = {along, across, up};
    for (int r = 0; r < 3; r++)
        text_add(out, "%.9g, %.9g, %.9g, ", row[r][0], row[r][1], row[r][2]);
    text_add(out, "0, 0, 0>\n    translate <%.9g, %.9g, %.9g>\n}\n", pivot[0], pivot[1], pivot[2]);
}
