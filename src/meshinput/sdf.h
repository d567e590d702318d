/* A triangle mesh as a solid: its signed distance on a sparse grid (OpenVDB).
 *
 * Distance   to the nearest triangle.
 * Sign       from the winding number: a point is inside if its absolute value is at least 1/2. So parts may overlap or intersect, there
 *            may be faces inside the solid, and a part with the opposite orientation inside of another one is a cavity.
 * Gaps       Across a hole the sign changes where there is no triangle. The distance to the nearest triangle there is half of the gap's
 *            width.
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

/* Computes the winding numbers of n points: winding_numbers(). */
typedef void sdf_winding_function(const void *context, const double (*x)[3], size_t n, float *number);

struct sdf_request {
    const double (*vertex)[3];
    size_t n_vertices;
    const uint32_t (*triangle)[3];
    size_t n_triangles;
    double voxel, band; /* m; distances are stored up to `band` from the surface */
    sdf_winding_function *winding;
    const void *context;
    const uint32_t (*open)[2]; /* open edges */
    size_t n_open;
    double hole; /* m: how far from an open edge the sign may change where there is no triangle */
};

struct vdb_sdf;

/* The same input gives the same bits, with any number of threads. E_MEMORY; E_INPUT: OpenVDB cannot make the grid. */
MUST_USE status vdb_sdf_create(const struct sdf_request *question, struct vdb_sdf **out);
/* A function given at samples, as struct solid_part describes it (reader/mesh_part.h). */
struct sdf_samples {
    size_t n;
    const int32_t (*at)[3];
    const float *value;            /* voxels */
    double voxel;                  /* m: the distance that a value of 1 stands for */
    double world_from_index[3][4]; /* the position of sample (i, j, k), m */
};
/* Their distance, trilinear between the samples; 2.25 voxels beyond them. E_MEMORY; E_INPUT: OpenVDB cannot make the grid. */
MUST_USE status vdb_sdf_from_samples(const struct sdf_samples *samples, struct vdb_sdf **out);

void vdb_sdf_destroy(struct vdb_sdf **sdf);

/* m, negative inside; +-band where the surface is farther away. Thread-safe. */
double vdb_sdf_at(const struct vdb_sdf *sdf, const double x[3]);

/* The widest gap. Gaps narrower than two voxels are not detected. */
struct sdf_gap {
    double width, at[3]; /* m; width 0: there is none; twice the band: that or wider */
};
struct sdf_gap vdb_sdf_gap(const struct vdb_sdf *sdf);

/* Triangles that close the gaps, within half a voxel. Some vertices are not used. E_MEMORY. */
struct sdf_caps {
    double (*vertex)[3]; /* the caller frees both */
    uint32_t (*triangle)[3];
    size_t n_vertices, n_triangles;
};
MUST_USE status vdb_sdf_caps(const struct vdb_sdf *sdf, struct sdf_caps *out);

#ifdef __cplusplus
}
#endif
#endif
