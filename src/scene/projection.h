/* Projects an image onto the rock: its brightness at points behind it. */
#ifndef HOODOO_PROJECTION_H
#define HOODOO_PROJECTION_H

#include <stdbool.h>

#include "base/status.h"
#include "job/job.h"

struct projection;

/* `h`: particle spacing, m. Errors of image_read(). */
MUST_USE status projection_create(const struct job_image *job, double h, struct projection **out);
void projection_destroy(struct projection **projection);

/* With image.depth_m the image only reaches that far behind the first rock: projection_add_occluder() must be called for every particle,
 * in any order, before the first projection_at(). Not thread-safe. */
bool projection_needs_occluders(const struct projection *projection);
void projection_add_occluder(struct projection *projection, const double x[3]);

/* 0..1; 0 beside the image, in front of it, and deeper than it reaches. */
double projection_at(const struct projection *projection, const double x[3]);

#endif
