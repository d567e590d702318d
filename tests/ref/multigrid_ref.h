/* The stress grid's equations solved in plain C, in OpenMP threads and float: conjugate gradients with the cycle that
 * src/stress/multigrid.h tells of. The grid and its vectors are elastic_ref.h's. */
#ifndef HOODOO_TESTS_MULTIGRID_REF_H
#define HOODOO_TESTS_MULTIGRID_REF_H

#include "tests/ref/elastic_ref.h"

struct multigrid_ref;

/* Levels for a shape. NULL: no memory. */
struct multigrid_ref *multigrid_ref_create(const struct elastic_grid *g, const float *fill);
void multigrid_ref_destroy(struct multigrid_ref *m);

/* From u = 0, `iterations` towards the equilibrium under `weight` (N, of a full cell); taken[i] is the energy that
 * iteration i took out of the error. Copies the displacement to u (vec4 [nodes]). */
void multigrid_ref_solve(struct multigrid_ref *m, double weight, int iterations, double *taken, float *u);

#endif
