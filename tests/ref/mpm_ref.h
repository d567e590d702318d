/* The ground is the plane of nodes three quarters of a cell below the domain.

 * One step of the material point method as the papers write it: particle by particle, node by node, in double
 * precision, with F itself and the stress's textbook forms. */
#ifndef HOODOO_TESTS_MPM_REF_H
#define HOODOO_TESTS_MPM_REF_H

#include <stddef.h>

struct mpm_ref_rock {
    int cells[3];
    double dx, dt; /* m, s */
    double density, lambda, mu, viscosity, rebound, gravity, friction, alpha;
};

struct mpm_ref_particle {
    double x[3], v[3], C[3][3], F[3][3]; /* [row][column] */
    double share, apart, strength;       /* apart < 0: whole */
};

void mpm_ref_step(const struct mpm_ref_rock *r, struct mpm_ref_particle *p, size_t n);

/* Elastic energy of a particle, J. */
double mpm_ref_energy(const struct mpm_ref_rock *r, const struct mpm_ref_particle *p);

#endif
