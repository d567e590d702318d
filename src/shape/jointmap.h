/* Columns of rock between joints, from a grey image (Goblins, section 4): no rock where it is black, and vertical sides.
 *
 * Values are at pixel centres. The outline is where the bilinear mask of rock is 1/2, so that it is smooth at any voxel size. With
 * jointmap.reach, grey is the height of a column. The image's bottom row is at min_m.y.
 */
#ifndef HOODOO_SHAPE_JOINTMAP_H
#define HOODOO_SHAPE_JOINTMAP_H

#include "base/status.h"
#include "job/job.h"

struct jointmap;

/* Errors of image_read(); E_INPUT: a value beyond 1e6; E_USAGE: the whole image is black. */
MUST_USE status jointmap_create(const struct job_jointmap *job, struct jointmap **out);
void jointmap_destroy(struct jointmap **map);

/* m, negative inside: exact in sign, in size a lower bound. */
double jointmap_distance(const struct jointmap *map, const double x[3]);

#endif
