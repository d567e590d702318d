/* What the files of this folder share. */
#ifndef HOODOO_WATER_INTERNAL_H
#define HOODOO_WATER_INTERNAL_H

#include "water/water.h"

/* The parameters of a kernel of n threads over the last routing's cells, spans and basins. */
struct water_params water_params(const struct water *w, size_t n);

/* Makes room for what is kept of every cell. */
MUST_USE status water_reserve_cells(struct gpu *gpu, struct water *w);

/* Makes room for n spans. */
MUST_USE status water_reserve(struct gpu *gpu, struct water *w, size_t n);

#endif
