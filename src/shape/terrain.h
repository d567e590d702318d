/* Stacks of layers, as model arches writes them, as a shape: rock, and what lies loose on it. */
#ifndef HOODOO_SHAPE_TERRAIN_H
#define HOODOO_SHAPE_TERRAIN_H

#include <stdbool.h>

#include "job/job.h"

struct terrain_shape;

/* Distances are wanted up to `reach` m from the surface. E_INPUT: the file. */
MUST_USE status terrain_shape_create(const struct job_stacks *job, double reach, struct terrain_shape **out);
void terrain_shape_destroy(struct terrain_shape **t);

/* Its size, m: from the origin. */
void terrain_shape_size(const struct terrain_shape *t, double size[3]);

/* m, negative inside: the sign is that of the smooth surface over all layers but water, the size no more than
 * the distance to it. */
double terrain_shape_distance(const struct terrain_shape *t, const double x[3]);

/* Is what is at x, or if that is air what is below it, loose? */
bool terrain_shape_loose(const struct terrain_shape *t, const double x[3]);

#endif
