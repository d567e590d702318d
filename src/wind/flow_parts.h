/* Internal interface between flow*.c. */
#ifndef HOODOO_FLOW_PARTS_H
#define HOODOO_FLOW_PARTS_H

#include "wind/flow.h"

/* Time step in spacing / wind speed. CFL: a particle at 2.5 times the wind speed, to which speeds are clamped and which air
 * around a rock hardly reaches, moves half a spacing, a quarter of the kernel support. */
#define FLOW_DT 0.2

static inline size_t box_count(const struct flow *f)
{
    return (size_t)f->box[0] * (size_t)f->box[1] * (size_t)f->box[2];
}

static inline size_t cell_count(const struct flow *f)
{
    return (size_t)f->cells[0] * (size_t)f->cells[1] * (size_t)f->cells[2];
}

static inline size_t ground_count(const struct flow *f)
{
    return (size_t)f->box[0] * (size_t)f->box[1];
}

/* Parameters common to the flow kernels; without the rock's voxels if p is NULL. */
struct flow_params flow_params_of(const struct flow *f, const struct particles *p);

/* Initial air: a lattice of particles in potential flow around the rock. Records only. */
void flow_fill(struct gpu *gpu, struct flow *f, struct particles *p);

/* ---- the average (flow_average.c): of blocks of samples, weighted by their steps */

/* Adds a sample of the air's velocities to the block. Records only. */
void flow_sample(struct gpu *gpu, struct flow *f);

/* Adds the block of `steps` steps to the average and starts a new one. *error: estimated error of the average within two
 * spacings of the rock, relative to its speeds (L2), from the difference between the block and the average before it, assuming
 * that the variance of each is inversely proportional to its length. INFINITY if there was no average before. Waits for the
 * device. */
MUST_USE status flow_add_block(struct gpu *gpu, struct flow *f, int steps, double *error);

/* Computes `mean` from the average. Records only. */
void flow_average(struct gpu *gpu, struct flow *f);

#endif
