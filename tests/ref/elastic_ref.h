/* The stress grid's equations, derived another way: element matrices by Gauss quadrature of B^T D B,
 * assembled element by element. The grid is that of shaders/stress/grid.glsl: cells with a margin of one,
 * nodes one more on each axis, vectors of four floats. */
#ifndef HOODOO_TESTS_ELASTIC_REF_H
#define HOODOO_TESTS_ELASTIC_REF_H

#include <stddef.h>

struct elastic_grid {
    int cells[3];
    double lambda, mu, dx; /* Pa, Pa, m */
};

size_t elastic_ref_cell(const struct elastic_grid *g, int i, int j, int k);
size_t elastic_ref_node(const struct elastic_grid *g, int i, int j, int k);

/* Rows and columns are 3 corner + axis; corner b is at (b & 1, b >> 1 & 1, b >> 2). */
void elastic_ref_element(const struct elastic_grid *g, double K[24][24]);

/* force = K u over all elements; a cell of which `fill` is rock has the share max(fill, 0.05) of the
 * stiffness, an empty one none. */
void elastic_ref_apply(const struct elastic_grid *g, const float *fill, const float *u, double *force);

/* Stress in a cell's middle: xx yy zz xy yz xz, Pa. */
void elastic_ref_stress(const struct elastic_grid *g, const float *u, int i, int j, int k, double stress[6]);

#endif
