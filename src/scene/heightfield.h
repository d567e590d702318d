/* The ground below a grey image: solid where min_m.z <= z <= height(x, y), within the rectangle.
 *
 * Values belong to the middles of pixels; between them bilinear, beyond the outermost the same. The image's
 * bottom row lies along min_m.y.
 */
#ifndef HOODOO_HEIGHTFIELD_H
#define HOODOO_HEIGHTFIELD_H

#include "base/status.h"
#include "job/job.h"

struct heightfield;

/* Distances are good up to `reach` metres (and may stop growing there). E_INPUT as image_read(), or a pixel
 * that is not a finite number. */
MUST_USE status heightfield_create(const struct job_heightfield *job, double reach, struct heightfield **out);
void heightfield_destroy(struct heightfield **field);

/* m, negative inside; the sign is exact, the size at most the true distance. */
double heightfield_distance(const struct heightfield *field, const double x[3]);

/* Height of its highest point, or min_m.z if that is higher. */
double heightfield_top(const struct heightfield *field);

#endif
