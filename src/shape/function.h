/* A shape by a formula: an expression in x, y and z, solid where its value is 0 or less, within a box.
 *
 * Distance   The value divided by the steepest slope of the expression is a lower bound of the distance. If the job does not give the
 *            slope (function.steepest), it is estimated as twice the steepest one found at 2^15 hashed positions in the box, by
 *            differences over `step` and step / 8.
 * Noise      noise(x, y, z) in expressions is noise_at() (noise.h) with zero mean, unit variance and a feature size of 1.
 */
#ifndef HOODOO_SHAPE_FUNCTION_H
#define HOODOO_SHAPE_FUNCTION_H

#include "job/job.h"

struct function;

/* `step`: the smallest size that matters, m. E_USAGE: the expression is malformed (with the position), has no finite value in the box, or
 * is steeper than function.steepest. */
MUST_USE status function_create(const struct job_function *job, double step, struct function **out);
void function_destroy(struct function **function);

/* m, negative inside: exact in sign, in size a lower bound. Where the expression is NaN is outside. */
double function_distance(const struct function *function, const double x[3]);

#endif
