/* Voxels of which a share is rock, as model goblins writes them (voxel_file.h), as a shape. Of a voxel that is partly rock, the part on one
 * side of a plane is inside: the plane across the gradient of the shares around it for which as many probes (probes.h) are inside as
 * the voxel has 64ths. So a scene whose voxels are those of the file gets their shares back, and another one a smooth surface. */
#ifndef HOODOO_SHAPE_VOXEL_SHAPE_H
#define HOODOO_SHAPE_VOXEL_SHAPE_H

#include "job/job.h"

struct voxel_shape;

/* E_INPUT: the file. E_MEMORY. */
MUST_USE status voxel_shape_create(const struct job_voxels *job, struct voxel_shape **out);
void voxel_shape_destroy(struct voxel_shape **v);

/* Its size, m; it starts at the origin. */
void voxel_shape_size(const struct voxel_shape *v, double size[3]);

/* The volume of its rock, m3. */
double voxel_shape_volume(const struct voxel_shape *v);

/* The distance to the surface, m, negative inside: exact in sign, in size a lower bound. Thread-safe. */
double voxel_shape_distance(const struct voxel_shape *v, const double x[3]);

#endif
