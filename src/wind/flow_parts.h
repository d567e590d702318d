/* The parts that a run of the air is made of: for flow*.c. */
#ifndef HOODOO_FLOW_PARTS_H
#define HOODOO_FLOW_PARTS_H

#include "wind/flow.h"

/* A step, in the time that the wind takes for a spacing: half a spacing, a quarter of the support, at 2.5 times the wind's speed, which
 * air around a rock hardly reaches and is held to. */
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

/* What all kernels of the air are told; without the rock's voxels if p is NULL. */
struct flow_params flow_params_of(const struct flow *f, const struct particles *p);

/* The first air: a lattice in potential flow around the rock. Records only. */
void flow_fill(struct gpu *gpu, struct flow *f, struct particles *p);

/* ---- the average (flow_average.c): of blocks of samples, weighted by their steps */

/* Takes the air's velocities into the block. Records only. */
void flow_sample(struct gpu *gpu, struct flow *f);

/* The average takes the block of so many steps in, and a new one begins. *error: how far the average may still
 * be from what it would become, as a share of the speeds within two spacings of the rock: by how far the block
 * is from what came before it, if the two are as uncertain as they are short. INFINITY if nothing came before.
 * Waits. */
MUST_USE status flow_settle(struct gpu *gpu, struct flow *f, int steps, double *error);

/* Fills `mean` from the average. Records only. */
void flow_average(struct gpu *gpu, struct flow *f);

#endif
