/* The ground below a height image: solid where min_m.z <= z <= height(x, y), within the rectangle min_m to max_m.
 *
 * Values are at pixel centres, bilinear between them and constant beyond the outermost. The image's bottom row is at min_m.y. With
 * nodata: empty there is no rock in the squares of pixels without a value.
 */
#ifndef HOODOO_SHAPE_HEIGHTFIELD_H
#define HOODOO_SHAPE_HEIGHTFIELD_H

#include "base/status.h"
#include "job/job.h"

struct heightfield;

/* Distances are useful up to `reach` metres and may stop growing there. Errors of image_read(); E_INPUT: a height beyond 1e7 m; E_USAGE:
 * max_m is omitted and the file does not state its extent in metres. */
MUST_USE status heightfield_create(const struct job_heightfield *job, double reach, struct heightfield **out);
void heightfield_destroy(struct heightfield **field);

/* m, negative inside: exact in sign, in size a lower bound. */
double heightfield_distance(const struct heightfield *field, const double x[3]);

/* The volume between min_m.z and the surface, integrated over the pixels, m3. */
double heightfield_volume(const struct heightfield *field);

/* Its bounding box, m. */
void heightfield_bounds(const struct heightfield *field, double min[3], double max[3]);

#endif
