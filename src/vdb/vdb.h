/* OpenVDB files: volumes and points to bytes, and back. The only door to OpenVDB, which is in hoodoo-vdb.so (base/library.h) for
 * what is made and in hoodoo-read (reader/reader.h) for what is read.
 *
 * Axes      In memory everything is in the simulator's axes (z up). Files are in the job's output.up: for y,
 *           index and world (x, y, z) become (x, z, -y). Readers here turn it back, going by the file's
 *           up_axis metadata.
 * Bytes     Files are made in memory, their random archive UUID is replaced by one derived from `identity`,
 *           and they hold no dates: equal input gives equal bytes. The caller writes them (atomic_file.h), so
 *           that a full disk is noticed.
 */
#ifndef HOODOO_VDB_H
#define HOODOO_VDB_H

#include <stdbool.h>
#include <stdint.h>

#include "base/status.h"
#include "particles/frame.h"

struct vdb_options {
    int up;                  /* OUTPUT_UP_* */
    int codec;               /* VDB_CODEC_* */
    bool half;               /* volumes only, but for values that may be beyond halves (values.def) */
    int points;              /* VDB_POINTS_* */
    int precision;           /* VDB_PRECISION_*: of points; in 16 bits P is within voxel / 65535 / 2 */
    bool moves;              /* USD points: with velocities */
    bool instances;          /* points: with `orient` (no turn) and `variant` (the layer), pscale 1 */
    int frame;               /* metadata */
    double spacing;          /* m: pscale is half of it; surface particles are those with a normal */
    uint64_t identity;       /* of run, frame and kind of file */
    const float (*color)[3]; /* Cd by layer */
    size_t n_colors;
};

/* A file in memory; freed with free(bytes). */
struct vdb_bytes {
    void *bytes;
    size_t size;
};

MUST_USE status vdb_volumes(const struct frame_grids *grids, const struct vdb_options *options,
                            struct vdb_bytes *out);
/* Points: a grid for each piece, `points`, `points_2` and so on. The rock alone, or with what a frame has behind it. */
MUST_USE status vdb_points(const struct rock *rock, const struct vdb_options *options, struct vdb_bytes *out);
MUST_USE status vdb_points_of_frame(const struct rock *rock, const struct frame_deep *deep,
                                    const struct vdb_options *options, struct vdb_bytes *out);

/* What a file holds: grids (name, type, class, active voxels or points, bounds in m in the file's axes,
 * attributes) and file metadata, written into `out` as a JSON object's members. E_INPUT if it is missing or
 * damaged; never crashes on hostile bytes (another program reads them: reader/reader.h). */
struct text;
MUST_USE status vdb_describe(const char *path, struct text *out);

/* The same without reading any voxels: grids with name, type, class, and the box in m (file's axes) of the
 * lattice each was written from. */
MUST_USE status vdb_describe_lattices(const char *path, struct text *out);

/* Reads every grid of the file completely. E_INPUT if anything is missing or damaged. */
MUST_USE status vdb_check(const char *path);

/* Back from files, in the simulator's axes. E_INPUT if the file is missing, damaged or holds something else.
 * Volumes: the grids with names hoodoo writes that the file holds, on the lattice they were written from, in the
 * bricks where any of them is something else than its background; what is inactive reads as 0, in level sets as
 * the background with its sign. Names are static; frame_grids_free(). Points: the fields of particles.def that the file holds, the others NULL;
 * rock_free(). Their order is the file's. */
MUST_USE status vdb_volumes_read(const char *path, struct frame_grids *out);
MUST_USE status vdb_points_read(const char *path, struct rock *out);

/* The zero surface of `surface` as triangles with outward normals, in the simulator's axes, and the values of
 * other grids at the vertices (trilinear; "vel.x" of a vector's). Closed, manifold and free of crossings (mesh/trimesh.h). */
struct vdb_mesh {
    size_t n_vertices, n_triangles;
    float *vertex;      /* [n_vertices][3] m */
    float *normal;      /* [n_vertices][3], from the level set's gradient, of the triangles where smoothed */
    uint32_t *triangle; /* [n_triangles][3], counter-clockwise from outside */
    float *value;       /* [n_values][n_vertices], NULL if none were asked for */
    uint32_t *label;    /* [n_vertices], NULL if none were asked for */
};

struct vdb_mesh_options {
    /* 0..1: for fewer triangles, no vertex that goes is farther than so many voxels from the surface left. */
    double adaptivity;
    int smooth; /* passes */
    const char *const *values;
    size_t n_values,
        n_optional; /* the last n_optional values are 0 where the file has no grid of that name */
    /* Labels of the n vertices, whose borders both keep; NULL: none. */
    status (*label)(void *user, const float (*vertex)[3], size_t n, uint32_t *label);
    void *user;
};

/* No vertex is smoothed farther than this, in voxels. */
#define VDB_MESH_SMOOTH_REACH 0.5

MUST_USE status vdb_mesh_make(const char *path, const struct vdb_mesh_options *options, struct vdb_mesh *out);

/* The same without smoothing and labels. */
MUST_USE status vdb_mesh_read(const char *path, double adaptivity, const char *const *values, size_t n_values,
                              size_t n_optional, struct vdb_mesh *out);
void vdb_mesh_free(struct vdb_mesh *mesh);

#endif
