/* Where beds that water does not pass lie, by column of voxels: of the job and its geology alone, whatever has eroded. */
#ifndef HOODOO_CONTACTS_H
#define HOODOO_CONTACTS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "base/status.h"
#include "job/job.h"

/* The top of such a bed: its highest one in a column that has rock which water passes right above it. */
struct contact {
    float z;        /* m; NAN: there is none */
    float lid;      /* m: the foot of the next bed above that water does not pass; INFINITY: there is none */
    uint32_t above; /* the stratum that lies on it */
};

struct contacts {
    size_t n_columns, n_beds;
    struct contact *at; /* [n_beds][n_columns], the upper strata's first */
};

/* The stratum's own conductivity, or the job's, m/yr. */
double contacts_conductivity(const struct job *job, size_t stratum);

/* Does the stratum hold water up? One whose conductivity is less than the recharge does: rain passes no bed faster than by its own weight. */
bool contacts_holds(const struct job *job, size_t stratum);

MUST_USE status contacts_create(const struct job *job, const int voxels[3], struct contacts *out);
void contacts_destroy(struct contacts *c);

/* Beds of the job, for what there has to be room for. */
size_t contacts_beds(const struct job *job);

#endif
