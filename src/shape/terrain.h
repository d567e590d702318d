/* Material stacks, as model arches writes them (stacks/FORMAT.md), as a shape: rock and loose material. */
#ifndef HOODOO_SHAPE_TERRAIN_H
#define HOODOO_SHAPE_TERRAIN_H

#include <stdbool.h>

#include "job/job.h"

struct terrain_shape;

/* Distances are useful up to `reach` m from the surface. E_INPUT: the file. E_MEMORY. */
MUST_USE status terrain_shape_create(const struct job_stacks *job, double reach, struct terrain_shape **out);
void terrain_shape_destroy(struct terrain_shape **t);

/* Its size, m; it starts at the origin. */
void terrain_shape_size(const struct terrain_shape *t, double size[3]);

/* The distance to the smooth surface (stacks/surface.h) of all layers except air and water, m, negative inside: exact in sign, in size a
 * lower bound. */
double terrain_shape_distance(const struct terrain_shape *t, const double x[3]);

/* Is the material at x loose? In air or water, that of the highest layer below x. */
bool terrain_shape_loose(const struct terrain_shape *t, const double x[3]);

#endif
