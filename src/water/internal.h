/* Internal interface of this folder. */
#ifndef HOODOO_WATER_INTERNAL_H
#define HOODOO_WATER_INTERNAL_H

#include "water/water.h"

/* Parameters of a kernel with n invocations on the last routing. */
struct water_params water_params(const struct water *w, size_t n);

/* Creates tag, z and receiver. */
MUST_USE status water_reserve_cells(struct gpu *gpu, struct water *w);

/* Grows the node arrays to at least n nodes; their contents are lost. */
MUST_USE status water_reserve(struct gpu *gpu, struct water *w, size_t n);

#endif
