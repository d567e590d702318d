/* A mesh file, or the surface of an OpenVDB grid, as a signed distance field in world space. */
#ifndef HOODOO_SHAPE_MESH_H
#define HOODOO_SHAPE_MESH_H

#include "meshinput/sdf.h"
#include "shape/placement.h"

/* Reads, repairs and voxelises a mesh. `detail`, `reach`: as for solid_create(). Outputs: *out, to be freed with vdb_sdf_destroy(); min and
 * max, its bounding box, m; *file_m3, the volume that its triangles enclose, or NAN if the mesh is open. E_INPUT: the file is missing,
 * damaged or hostile, or its surface has gaps wider than job->fill_holes_m and a spacing. E_MEMORY. */
MUST_USE status mesh_shape_create(const struct job_mesh *job, const struct placement *place, double detail,
                                  double reach, struct vdb_sdf **out, double min[3], double max[3],
                                  double *file_m3);

/* The same for the surface of an OpenVDB grid. E_INPUT: the file is missing, damaged or hostile, or has no such grid or surface. */
MUST_USE status volume_shape_create(const struct job_volume *job, const struct placement *place,
                                    double detail, double reach, struct vdb_sdf **out, double min[3],
                                    double max[3], double *file_m3);

#endif
