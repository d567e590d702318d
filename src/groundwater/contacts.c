#include "groundwater/contacts.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "geology/attitude.h"

/* Samples per voxel along a column; a contact between two samples is then found by bisection to a millionth of their distance. */
enum { LOOKS = 4, HALVINGS = 20 };

double contacts_conductivity(const struct job *job, size_t stratum)
{
    const double own = job->strata[stratum].conductivity_m_per_yr;
    return own >= 0 ? own : job->groundwater.conductivity_m_per_yr;
}

bool contacts_holds(const struct job *job, size_t stratum)
{
    return contacts_conductivity(job, stratum) < job->groundwater.recharge_m_per_yr;
}

size_t contacts_beds(const struct job *job)
{
    size_t n = 0;
    for (size_t l = 0; l < job->n_strata; l++)
        n += contacts_holds(job, l);
    return n;
}

/* Bisection between a height in the stratum `below` and one that is not, in the column at x. */
static double edge_between(const struct job *job, double x[3], double low, double high, size_t below)
{
    for (int i = 0; i < HALVINGS; i++) {
        x[2] = (low + high) / 2;
        *(attitude_layer(job, x) == below ? &low : &high) = x[2];
    }
    return (low + high) / 2;
}

/* Scans a column from the top down. */
static void look_down(const struct job *job, const int voxels[3], const size_t *bed_of, struct contacts *c,
                      size_t column, double x[3])
{
    const double h = job->domain.spacing_m, step = h / LOOKS;
    double lid = INFINITY;
    size_t above = SIZE_MAX;
    for (int k = LOOKS * voxels[2] - 1; k >= 0; k--) {
        x[2] = (k + 0.5) * step;
        const size_t layer = attitude_layer(job, x);
        if (contacts_holds(job, layer) && above != SIZE_MAX && !contacts_holds(job, above)) {
            struct contact *to = &c->at[bed_of[layer] * c->n_columns + column];
            const double z = edge_between(job, x, (k + 0.5) * step, (k + 1.5) * step, layer);
            if (isnan(to->z))
                *to = (struct contact){(float)z, (float)lid, (uint32_t)above};
        }
        if (contacts_holds(job, layer))
            lid = k * step;
        above = layer;
    }
}

status contacts_create(const struct job *job, const int voxels[3], struct contacts *c)
{
    status st = OK;
    const double h = job->domain.spacing_m;
    size_t *bed_of = NULL;
    *c = (struct contacts){.n_columns = (size_t)voxels[0] * (size_t)voxels[1], .n_beds = contacts_beds(job)};
    TRY(memory_alloc(job->n_strata, sizeof *bed_of, "beds", &bed_of));
    for (size_t l = job->n_strata, n = 0; l-- > 0;)
        if (contacts_holds(job, l))
            bed_of[l] = n++;
    TRY(memory_alloc(c->n_beds * c->n_columns, sizeof *c->at, "contacts of beds", &c->at));
    for (size_t i = 0; i < c->n_beds * c->n_columns; i++)
        c->at[i].z = NAN;
    const ptrdiff_t different = attitude_is_level(job) ? 1 : (ptrdiff_t)c->n_columns;
#pragma omp parallel for schedule(static)
    for (ptrdiff_t i = 0; i < different; i++) {
        double x[3] = {((double)(i % voxels[0]) + 0.5) * h, ((double)(i / voxels[0]) + 0.5) * h, 0};
        look_down(job, voxels, bed_of, c, (size_t)i, x);
    }
    for (size_t b = 0; b < c->n_beds; b++)
        for (size_t i = (size_t)different; i < c->n_columns; i++)
            c->at[b * c->n_columns + i] = c->at[b * c->n_columns];
done:
    free(bed_of);
    if (st != OK)
        contacts_destroy(c);
    return st;
}

void contacts_destroy(struct contacts *c)
{
    free(c->at);
    *c = (struct contacts){0};
}
