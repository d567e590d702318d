/* Weights of paint from the vertices of a mesh (paint.mesh_attribute). */
#ifndef HOODOO_VERTEX_PAINT_H
#define HOODOO_VERTEX_PAINT_H

#include "base/status.h"
#include "job/job.h"

struct vertex_paint;

/* Reads and places the mesh. E_INPUT: the file is missing, damaged or hostile, or its vertices lack the attribute. E_MEMORY. */
MUST_USE status vertex_paint_create(const struct job_mesh_attribute *job, struct vertex_paint **out);
void vertex_paint_destroy(struct vertex_paint **paint);

/* The weight at x, 0..1: the attribute at the nearest point of the mesh, interpolated between the corners of its triangle, from `from` (0)
 * to `to` (1). 0 farther than depth_m from the mesh. Thread-safe. */
double vertex_paint_at(const struct vertex_paint *paint, const double x[3]);

#endif
