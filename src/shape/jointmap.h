/* Columns of rock between joints, from a grey image (Goblins, section 4): no rock where it is black, and
 * straight sides everywhere else.
 *
 * Values belong to the middles of pixels; the outline runs where the bilinear mask of rock is 1/2, so that it
 * is smooth at any voxel size. With `reach`, grey is how high a column reaches. The image's bottom row lies
 * along min_m.y.
 */
#ifndef HOODOO_SHAPE_JOINTMAP_H
#define HOODOO_SHAPE_JOINTMAP_H

#include "base/status.h"
#include "job/job.h"

struct jointmap;

/* E_INPUT as image_read(), or a pixel that is not a finite number. E_USAGE: all of it is black. */
MUST_USE status jointmap_create(const struct job_jointmap *job, struct jointmap **out);
void jointmap_destroy(struct jointmap **map);

/* m, negative inside; the sign is exact, the size at most the true distance. */
double jointmap_distance(const struct jointmap *map, const double x[3]);

#endif
