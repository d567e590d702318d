/* Infiltrated rain: down each column to the first bed that holds it, along that bed to where the rock ends, then out or down to the
 * next bed. */
#ifndef HOODOO_COLUMNS_OF_WATER_H
#define HOODOO_COLUMNS_OF_WATER_H

#include "groundwater/aquifer.h"
#include "groundwater/contacts.h"

/* Water balance, m3/yr: recharge = faces + sides + tops + ceilings + deep, up to `left`. */
struct groundwater_sums {
    double recharge; /* infiltration */
    double faces;    /* seepage on beds where the rock ends in air */
    double sides;    /* outflow on beds at the domain's open sides */
    double tops;     /* outflow where the water table reaches the rock's top */
    double ceilings; /* dripping from ceilings */
    double deep;     /* percolation where no bed holds it */
    double left;     /* largest residual of a bed's balance, as a share of its recharge */
    int rounds;      /* largest number of solver rounds for a bed */
};

/* The wet zone of a bed in a column, in the device's layout. */
struct wet {
    float base, top; /* m: bottom and top of the rock on the bed */
    float face;      /* m/yr: seepage of the wet zone of its faces */
    float over;      /* m/yr: seepage of its top */
    float front;     /* length of its open faces, in column widths */
    float spare[3];
};

struct columns {
    const struct job *job;
    int voxels[3];
    struct contacts contacts;
    struct aquifer aquifer;
    struct fivepoint_solver *solver;
    uint32_t *rock;        /* voxels that are rock, as bits; rows along x begin on whole words */
    double *down;          /* m3/yr: water that percolates down each column, */
    int *from;             /* below this voxel */
    double *flow, *length; /* by column: outflow of faces, m3/yr, and their length, m */
    struct wet *wet;       /* [n_beds][n_columns] */
    struct groundwater_sums sums;
};

/* `job` is borrowed and must outlive *out. The caller fills out->rock before each columns_find(). */
MUST_USE status columns_create(const struct job *job, const int voxels[3], struct columns *out);
void columns_destroy(struct columns *c);

/* Computes `wet` and `sums` from `rock`. */
void columns_find(struct columns *c);

#endif
