/* Brush strokes: all points within a radius of a polyline. */
#ifndef HOODOO_SHAPE_STROKE_H
#define HOODOO_SHAPE_STROKE_H

#include "base/status.h"
#include "job/job.h"

struct stroke;

/* Copies the points. E_USAGE: there are none. E_MEMORY. */
MUST_USE status stroke_create(const struct job_stroke *job, struct stroke **out);
void stroke_destroy(struct stroke **stroke);

/* Its bounding box, m. */
void stroke_bounds(const struct stroke *stroke, double min[3], double max[3]);

/* m, negative inside; exact outside. */
double stroke_distance(const struct stroke *stroke, const double x[3]);

#endif
