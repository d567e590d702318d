/* The order of triangles along a Morton curve, in which neighbours in space are mostly neighbours in the list: cut into pieces of equal
 * length, it makes a tree of boxes without further sorting. */
#ifndef HOODOO_MESHINPUT_CURVE_H
#define HOODOO_MESHINPUT_CURVE_H

#include <stddef.h>
#include <stdint.h>

#include "base/status.h"

/* *order: the numbers of the n triangles, by the centroids' position in the box lo..hi, which holds all vertices; the caller frees it.
 * E_MEMORY. */
MUST_USE status curve_order(const double (*vertex)[3], const uint32_t (*triangle)[3], size_t n,
                            const double lo[3], const double hi[3], uint32_t **order);

#endif
