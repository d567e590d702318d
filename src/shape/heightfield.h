/* The ground below a grey image: solid where min_m.z <= z <= height(x, y), within the rectangle.
 *
 * Values belong to the middles of pixels; between them bilinear, beyond the outermost the same. The image's
 * bottom row lies along min_m.y. With nodata: empty, the squares of pixels without a value hold no rock.
 */
#ifndef HOODOO_SHAPE_HEIGHTFIELD_H
#define HOODOO_SHAPE_HEIGHTFIELD_H

#include "base/status.h"
#include "job/job.h"

struct heightfield;

/* Distances are good up to `reach` metres (and may stop growing there). E_INPUT as image_read(). E_USAGE as image_read(), or the file
 * is to say how large it is and does not. */
MUST_USE status heightfield_create(const struct job_heightfield *job, double reach, struct heightfield **out);
void heightfield_destroy(struct heightfield **field);

/* m, negative inside; the sign is exact, the size at most the true distance. */
double heightfield_distance(const struct heightfield *field, const double x[3]);

/* m3 between min_m.z and the ground, as the pixels have it. */
double heightfield_volume(const struct heightfield *field);

/* A box around it, m. */
void heightfield_bounds(const struct heightfield *field, double min[3], double max[3]);

#endif
