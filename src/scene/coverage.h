/* Which share of each voxel of the domain is rock.
 *
 * Voxels are looked at in bricks of 4 x 4 x 4, most of which one distance settles as full or empty; only
 * bricks that the surface may cross store a byte a voxel, so that memory goes with the surface and not with
 * the domain.
 */
#ifndef HOODOO_COVERAGE_H
#define HOODOO_COVERAGE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "base/status.h"

enum { BRICK = 4, COVERAGE_FULL = 64 };

/* How far from the surface a brick's middle can be and the surface still cross it, in spacings: half its
 * diagonal. Distances must be good to here. */
#define COVERAGE_REACH (0.87 * BRICK)

struct solid;
struct coverage;

MUST_USE status coverage_create(const struct solid *solid, const int n[3], double h, struct coverage **out);
void coverage_destroy(struct coverage **coverage);

/* 0 to COVERAGE_FULL, in sixty-fourths. */
unsigned coverage_at(const struct coverage *coverage, int i, int j, int k);

/* The same for one voxel, straight from the solid. */
unsigned coverage_of_voxel(const struct solid *solid, double h, int i, int j, int k);

/* coverage_of_voxel() > 0, without counting on. */
bool coverage_holds_rock(const struct solid *solid, double h, int i, int j, int k);

#endif
