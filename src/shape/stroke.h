/* Brush strokes: all within a radius of a line of points. */
#ifndef HOODOO_SHAPE_STROKE_H
#define HOODOO_SHAPE_STROKE_H

#include "base/status.h"
#include "job/job.h"

struct stroke;

/* The points are copied. E_USAGE: there is none. */
MUST_USE status stroke_create(const struct job_stroke *job, struct stroke **out);
void stroke_destroy(struct stroke **stroke);

/* The box around it, m. */
void stroke_bounds(const struct stroke *stroke, double min[3], double max[3]);

/* m, negative inside; exact outside. */
double stroke_distance(const struct stroke *stroke, const double x[3]);

#endif
