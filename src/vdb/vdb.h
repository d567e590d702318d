/* OpenVDB files: encoding volumes and points, and reading them back. The only interface to OpenVDB, which is in hoodoo-vdb.so
 * (system/library.h) for encoding and in hoodoo-read (reader/reader.h) for reading.
 *
 * Axes      In memory everything is in the simulator's axes (z up). Files have the axes of the job's output.up: for y, index and world
 *           space (x, y, z) become (x, z, -y). Reading converts back, by the file's up_axis metadata.
 * Bytes     Files are encoded into a draft (system/draft.h) without dates, and their random archive UUID is replaced by one derived from
 *           `identity`, so equal input gives equal bytes. On an error the caller drops the draft.
 */
#ifndef HOODOO_VDB_H
#define HOODOO_VDB_H

#include <stdbool.h>
#include <stdint.h>

#include "base/status.h"
#include "particles/frame.h"
#include "system/draft.h"

struct vdb_options {
    int up;                  /* OUTPUT_UP_* */
    int codec;               /* VDB_CODEC_* */
    bool half;               /* of volumes; not for values that may exceed halves (values.def) */
    int points;              /* VDB_POINTS_* */
    int precision;           /* VDB_PRECISION_* of points; with 16 bits P is within voxel / 65535 / 2 */
    bool moves;              /* USD points have velocities */
    bool instances;          /* points have `orient` (identity) and `variant` (the layer), and pscale 1 */
    int frame;               /* metadata */
    double spacing;          /* m; pscale is half of it */
    uint64_t identity;       /* hash of run, frame and kind of file */
    const float (*color)[3]; /* [n_colors] Cd by layer */
    size_t n_colors;
};

/* Volumes are made grid by grid. Samples that are not in memory are read from the grids' source one grid at a time (grids.h). */
MUST_USE status vdb_volumes(const struct frame_grids *grids, const struct vdb_options *options,
                            struct draft *out);
/* Points: one grid per piece, named `points`, `points_2` and so on. vdb_points_of_frame() includes the frame's deep rock; `deep` may be
 * NULL. */
MUST_USE status vdb_points(const struct rock *rock, const struct vdb_options *options, struct draft *out);
MUST_USE status vdb_points_of_frame(const struct rock *rock, const struct frame_deep *deep,
                                    const struct vdb_options *options, struct draft *out);

/* Adds a description of a file to `out`, as members of a JSON object: its metadata and grids (name, type, class, number of active voxels or
 * points, bounds in m in the file's axes, attributes). E_INPUT if the file is missing or damaged. Hostile files are safe, since another
 * process reads them (reader/reader.h). */
struct text;
MUST_USE status vdb_describe(const char *path, struct text *out);

/* The same without reading voxels: for each grid its name, type, class, and the box in m (file's axes) of the lattice from which it was
 * written. */
MUST_USE status vdb_describe_lattices(const char *path, struct text *out);

/* Reads every grid of the file completely. E_INPUT if the file is missing or damaged. */
MUST_USE status vdb_check(const char *path);

/* Read files back, in the simulator's axes. E_INPUT if the file is missing, damaged or has other content.
 * Volumes: the file's grids with names that hoodoo writes, on the lattice from which they were written, in the bricks where any of them
 * differs from its background. Inactive voxels are 0, in level sets the background with its sign. Names are static. Free with
 * frame_grids_free().
 * Points: the fields of particles.def that the file has, others NULL, in the order of the file. Free with rock_free(). */
MUST_USE status vdb_volumes_read(const char *path, struct frame_grids *out);
MUST_USE status vdb_points_read(const char *path, struct rock *out);

/* The zero surface of the grid `surface` as triangles, in the simulator's axes, with the values of other grids at the vertices (trilinear;
 * "vel.x" is a component of a vector). Closed, manifold and free of self-intersections (mesh/trimesh.h). */
struct vdb_mesh {
    size_t n_vertices, n_triangles;
    float *vertex; /* [n_vertices][3] m */
    float
        *normal; /* [n_vertices][3], outward: the level set's gradient or, if smoothed, from the triangles */
    uint32_t *triangle; /* [n_triangles][3], counter-clockwise as seen from outside */
    float *value;       /* [n_values][n_vertices], or NULL if no values were requested */
    uint32_t *label;    /* [n_vertices], or NULL without a label function */
};

struct vdb_mesh_options {
    /* 0..1 voxels: simplification removes vertices that are at most this far from the resulting surface. */
    double adaptivity;
    int smooth; /* passes */
    const char *const *values;
    size_t n_values, n_optional; /* the last n_optional values are 0 if the file has no grid of that name */
    /* Sets the labels of n vertices; smoothing and simplification preserve borders between labels. May be NULL. */
    status (*label)(void *user, const float (*vertex)[3], size_t n, uint32_t *label);
    void *user;
};

/* Voxels: smoothing moves no vertex farther than this. */
#define VDB_MESH_SMOOTH_REACH 0.5

MUST_USE status vdb_mesh_make(const char *path, const struct vdb_mesh_options *options, struct vdb_mesh *out);

/* The same without smoothing and labels. Free with vdb_mesh_free(). */
MUST_USE status vdb_mesh_read(const char *path, double adaptivity, const char *const *values, size_t n_values,
                              size_t n_optional, struct vdb_mesh *out);
void vdb_mesh_free(struct vdb_mesh *mesh);

#endif
