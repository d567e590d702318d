/* Tops of the beds that hold water, by column of voxels: functions of the job and its geology, independent of erosion. */
#ifndef HOODOO_CONTACTS_H
#define HOODOO_CONTACTS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "base/status.h"
#include "job/job.h"

/* The highest top of a bed in a column that has permeable rock right above it. */
struct contact {
    float z;        /* m; NAN: none */
    float lid;      /* m: bottom of the next bed above that holds water; INFINITY: none */
    uint32_t above; /* stratum on top of the bed */
};

struct contacts {
    size_t n_columns, n_beds;
    struct contact *at; /* [n_beds][n_columns], upper strata first */
};

/* Conductivity of a stratum, its own or the job's, m/yr. */
double contacts_conductivity(const struct job *job, size_t stratum);

/* Whether the stratum holds water: if its conductivity is less than the recharge, since flow under gravity alone is no faster. */
bool contacts_holds(const struct job *job, size_t stratum);

MUST_USE status contacts_create(const struct job *job, const int voxels[3], struct contacts *out);
void contacts_destroy(struct contacts *c);

/* Number of the job's beds that hold water, for sizes. */
size_t contacts_beds(const struct job *job);

#endif
