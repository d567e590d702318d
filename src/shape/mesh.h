/* A mesh file, or the surface of an OpenVDB grid, as a solid standing in the world. */
#ifndef HOODOO_SHAPE_MESH_H
#define HOODOO_SHAPE_MESH_H

#include "meshinput/sdf.h"
#include "shape/placement.h"

/* `detail`, `reach`: as for solid_create(). min and max come back as the box around it, *own_m3 as
 * what its triangles enclose, NAN of an open mesh. E_INPUT: the file is
 * missing, damaged or hostile, or its surface has gaps that are wider than job->fill_holes_m and a spacing. */
MUST_USE status mesh_solid(const struct job_mesh *job, const struct placement *place, double detail,
                           double reach, struct vdb_sdf **out, double min[3], double max[3], double *own_m3);

/* E_INPUT: the file is missing, damaged or hostile, or has no such grid or surface. */
MUST_USE status volume_solid(const struct job_volume *job, const struct placement *place, double detail,
                             double reach, struct vdb_sdf **out, double min[3], double max[3],
                             double *own_m3);

#endif
