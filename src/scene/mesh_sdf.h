/* A closed triangle mesh as a solid: its signed distance on a sparse grid (OpenVDB).
 *
 * Sign: what cannot be reached from far away is inside, so faces may be turned either way and parts may
 * overlap or cut each other; holes smaller than `voxel` are closed by the sampling, and a cavity without an
 * opening counts as solid.
 */
#ifndef HOODOO_MESH_SDF_H
#define HOODOO_MESH_SDF_H

#include <stddef.h>
#include <stdint.h>

#include "base/status.h"

struct vdb_sdf;

/* Distances reach `band` metres to either side of the surface. Equal input gives equal bits: it runs on one
 * thread. */
MUST_USE status vdb_sdf_from_mesh(const double (*vertex)[3], size_t n_vertices, const uint32_t (*triangle)[3],
                                  size_t n_triangles, double voxel, double band, struct vdb_sdf **out);
void vdb_sdf_destroy(struct vdb_sdf **sdf);

/* m, negative inside; +-band where the surface is farther than that. Safe from many threads. */
double vdb_sdf_at(const struct vdb_sdf *sdf, const double x[3]);

#endif
