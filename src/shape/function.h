/* A shape by a formula: rock where an expression in x, y and z is 0 or less, within a box.
 *
 * Distance   An expression's value may be any number, and rise by any number a metre. The value by the steepest rise is no more
 *            than the distance. What the job does not say (function.steepest) is measured: twice the steepest rise, over a step and over
 *            an eighth of one, at 2^15 places spread over the box by a hash.
 * Noise      noise(x, y, z) is the scene's (noise.h), of zero mean, unit variance and patches of size 1.
 */
#ifndef HOODOO_SHAPE_FUNCTION_H
#define HOODOO_SHAPE_FUNCTION_H

#include "job/job.h"

struct function;

/* `step`: what is smaller will not be seen, m. E_USAGE: the expression is none, and where; or it has no value in the box, or is steeper
 * than the job says. */
MUST_USE status function_create(const struct job_function *job, double step, struct function **out);
void function_destroy(struct function **function);

/* m, negative inside; exact in sign. What is no number counts as outside. */
double function_distance(const struct function *function, const double x[3]);

#endif
