/* A triangle mesh as a solid: its signed distance on a sparse grid (OpenVDB).
 *
 * Size   from the triangles.
 * Sign   from their winding number: inside is where it is at least a half, of either sign. So parts may overlap or cut each
 *        other, faces may lie within, and what winds the other way around a cavity leaves it empty.
 * Gaps   Across a hole the sign changes where there is no triangle. How far from the nearest triangle it does tells how
 *        wide the hole is.
 */
#ifndef HOODOO_MESHINPUT_SDF_H
#define HOODOO_MESHINPUT_SDF_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "base/status.h"

#ifdef __cplusplus
extern "C" {
#endif

/* The winding numbers of n points. */
typedef void sdf_winding_function(const void *context, const double (*x)[3], size_t n, float *number);

struct sdf_question {
    const double (*vertex)[3];
    size_t n_vertices;
    const uint32_t (*triangle)[3];
    size_t n_triangles;
    double voxel, band; /* m; distances reach `band` to either side of the surface */
    sdf_winding_function *winding;
    const void *context;
    /* Edges at which the surface ends, and how far from them its sign may change where there is no triangle, m. */
    const uint32_t (*open)[2];
    size_t n_open;
    double hole;
};

struct vdb_sdf;

/* Equal input gives equal bits, whatever the threads. */
MUST_USE status vdb_sdf_create(const struct sdf_question *question, struct vdb_sdf **out);
void vdb_sdf_destroy(struct vdb_sdf **sdf);

/* m, negative inside; +-band where the surface is farther than that. Safe from many threads. */
double vdb_sdf_at(const struct vdb_sdf *sdf, const double x[3]);

/* The widest gap that was found, where: gaps narrower than two voxels are not. */
struct sdf_gap {
    double width, at[3]; /* m; 0: none. Twice the band: that, or wider */
};
struct sdf_gap vdb_sdf_gap(const struct vdb_sdf *sdf);

/* What closes the gaps: triangles across them, to half a voxel. Some vertices have none. */
struct sdf_caps {
    double (*vertex)[3]; /* freed with free(), both */
    uint32_t (*triangle)[3];
    size_t n_vertices, n_triangles;
};
MUST_USE status vdb_sdf_caps(const struct vdb_sdf *sdf, struct sdf_caps *out);

#ifdef __cplusplus
}
#endif
#endif
