/* Where crumbs may land, in plain C over voxels: heights column by column, means, slopes (deposit/slope.glsl). */
#ifndef HOODOO_TESTS_SLOPE_REF_H
#define HOODOO_TESTS_SLOPE_REF_H

#include <stdint.h>

#include "routing_ref.h"

/* How many crumbs may land in cell c, `most` at most; solid: a byte a voxel. 0 if the cell is not ground. */
unsigned slope_ref_room(const uint8_t *solid, const int voxels[3], const struct routing_ref *way, size_t c,
                        double repose_deg, unsigned most);

#endif
