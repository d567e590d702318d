/* The share of each voxel of the domain that is inside a solid.
 *
 * Voxels are examined in bricks of 4 x 4 x 4. A single distance shows most bricks to be full or empty; only bricks that the surface may
 * cross store a byte per voxel, so that memory grows with the surface and not with the volume.
 */
#ifndef HOODOO_COVERAGE_H
#define HOODOO_COVERAGE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "base/status.h"
#include "shape/probes.h"

enum { BRICK = 4, COVERAGE_FULL = PROBES };

/* Half the diagonal of a brick, in spacings: if its centre is farther from the surface, the surface does not cross it. The solid's
 * distances must reach this far. */
#define COVERAGE_REACH (0.87 * BRICK)

struct solid;
struct coverage;

/* Domain of n voxels of h metres. E_MEMORY. */
MUST_USE status coverage_create(const struct solid *solid, const int n[3], double h, struct coverage **out);
void coverage_destroy(struct coverage **coverage);

/* The share of voxel (i, j, k), in sixty-fourths: 0 to COVERAGE_FULL. */
unsigned coverage_at(const struct coverage *coverage, int i, int j, int k);

/* The same, computed from the solid. */
unsigned coverage_of_voxel(const struct solid *solid, double h, int i, int j, int k);

/* coverage_of_voxel() > 0, but stops at the first probe inside. */
bool coverage_holds_rock(const struct solid *solid, double h, int i, int j, int k);

#endif
