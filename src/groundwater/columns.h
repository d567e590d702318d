/* Rain that sinks into rock: down each column to the first bed that holds it, along that bed to where the rock ends, out or farther
 * down. */
#ifndef HOODOO_COLUMNS_OF_WATER_H
#define HOODOO_COLUMNS_OF_WATER_H

#include "groundwater/aquifer.h"
#include "groundwater/contacts.h"

/* Where water goes, m3/yr. Their sum, but for the first, is the first. */
struct groundwater_sums {
    double recharge; /* what sinks into the rock */
    double faces;    /* comes out on beds where the rock ends, */
    double sides;    /* the same at the domain's open sides, */
    double tops;     /* where the water table is as high as the rock, */
    double ceilings; /* or drips from ceilings */
    double deep;     /* goes down where no bed holds it */
    double left;     /* the largest share of a bed's recharge that its balance leaves open */
    int rounds;      /* of the solver, the most for a bed */
};

/* What is wet in a column, as the device reads it. */
struct wet {
    float base, top; /* m: of the rock on the bed */
    float face;      /* m/yr: out of the wet zone of its faces */
    float over;      /* m/yr: out of its top */
    float front;     /* how long its open faces are, in widths of a column */
    float spare[3];
};

struct columns {
    const struct job *job;
    int voxels[3];
    struct contacts contacts;
    struct aquifer aquifer;
    struct fivepoint_solver *solver;
    uint32_t *rock;        /* bits, a row along x in whole words: which voxels are rock */
    double *down;          /* m3/yr: what sinks in each column, */
    int *from;             /* from this voxel */
    double *flow, *length; /* by column: out of faces, m3/yr, and how long these are, m */
    struct wet *wet;       /* [n_beds][n_columns] */
    struct groundwater_sums sums;
};

/* The job outlives it; not its rock, which is to be filled each time. */
MUST_USE status columns_create(const struct job *job, const int voxels[3], struct columns *out);
void columns_destroy(struct columns *c);

/* From `rock` to `wet` and `sums`. */
void columns_find(struct columns *c);

#endif
