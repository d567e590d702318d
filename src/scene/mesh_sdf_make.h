/* What mesh_sdf.h calls in hoodoo-vdb.so. */
#ifndef HOODOO_MESH_SDF_MAKE_H
#define HOODOO_MESH_SDF_MAKE_H

#include <stddef.h>
#include <stdint.h>

#include "base/status.h"

#ifdef __cplusplus
extern "C" {
#endif

struct vdb_sdf;

typedef status sdf_make_function(const double (*vertex)[3], size_t n_vertices, const uint32_t (*triangle)[3],
                                 size_t n_triangles, double voxel, double band, struct vdb_sdf **out);
typedef void sdf_destroy_function(struct vdb_sdf **sdf);
typedef double sdf_at_function(const struct vdb_sdf *sdf, const double x[3]);

sdf_make_function sdf_make;
sdf_destroy_function sdf_destroy;
sdf_at_function sdf_at;

#ifdef __cplusplus
}
#endif
#endif
