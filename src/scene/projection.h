/* A picture thrown onto the rock: how bright it is at a point behind it. */
#ifndef HOODOO_PROJECTION_H
#define HOODOO_PROJECTION_H

#include <stdbool.h>

#include "base/status.h"
#include "job/job.h"

struct projection;

/* `h`: the particles' spacing, m. E_INPUT: the file. */
MUST_USE status projection_create(const struct job_image *job, double h, struct projection **out);
void projection_destroy(struct projection **projection);

/* With a depth, rock hides what is behind it: every particle must be shown to projection_see() before the first
 * projection_at(). The order does not matter; one at a time. */
bool projection_sees(const struct projection *projection);
void projection_see(struct projection *projection, const double x[3]);

/* 0..1; 0 beside the picture, in front of it, and deeper than it reaches. */
double projection_at(const struct projection *projection, const double x[3]);

#endif
