/* The air's equations written plainly: every pair, in double. Units as in wind/flow.h. */
#ifndef HOODOO_TESTS_WIND_REF_H
#define HOODOO_TESTS_WIND_REF_H

#include <stddef.h>

enum wind_ref_kind { REF_AIR, REF_SKIN, REF_ROCK, REF_GROUND };

struct wind_ref_particle {
    double x[3], v[3], volume, pressure;
    enum wind_ref_kind kind;
};

struct wind_ref_result {
    double density, factor, compression; /* factor: of the Jacobi iteration */
    double crowd[3], drag[3];            /* sum of slopes; viscosity's sum, without its coefficient */
    double push[3];                      /* change of velocity by the pressures */
    double left;                         /* compression with that change */
    int neighbours;
};

double wind_ref_kernel(double r);

/* out[i] for all n. Particles that are not air get zeros. */
void wind_ref(const struct wind_ref_particle *p, size_t n, struct wind_ref_result *out);

/* What a boundary particle stands for. */
double wind_ref_volume(const struct wind_ref_particle *p, size_t n, size_t i);

/* Potential flow through n[0] x n[1] x n[2] cells, numbered (k n[1] + j) n[0] + i, from a wind along x and y: at
 * the sides cells are REF_SKIN and move with the wind, what is not REF_AIR otherwise lets nothing through. v[i] is
 * the velocity in the middles of those that are REF_AIR. */
void wind_ref_potential(const int n[3], const enum wind_ref_kind *cell, const double wind[2], double (*v)[3]);

#endif
