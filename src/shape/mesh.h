/* A mesh file, or the surface of an OpenVDB grid, as a signed distance field in world space. */
#ifndef HOODOO_SHAPE_MESH_H
#define HOODOO_SHAPE_MESH_H

#include "meshinput/mesh.h"
#include "meshinput/sdf.h"
#include "shape/placement.h"

struct mesh_source {
    const char *file, *key; /* key: the name of the job's section, for messages */
    const char *attribute;  /* NULL: none */
    bool y_up, auto_origin;
    const struct placement *place;
};

/* Reads a mesh with its vertices in world space, and extends min..max by them, m. Free *mesh with mesh_free(), also on error. E_INPUT: the
 * file is missing, damaged or hostile, has no such attribute, or is farther than 1e6 m from the origin. E_MEMORY. */
MUST_USE status mesh_read_placed(const struct mesh_source *source, struct mesh *mesh, double min[3],
                                 double max[3]);

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
