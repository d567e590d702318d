/* The surface field: the rock as a signed distance on a lattice, and averages of its particles' values.
 *
 * The surface is not Zhu and Bridson's average of spheres but the level 1/2 of the rock's share of space, filtered over 1.5 voxels. On a
 * plane face it is exactly where the particles' fill (their viability) puts it. So it moves smoothly while particles weather, encloses
 * their volume, and does not depend on the particles' positions in their voxels. The distance is computed from that surface by upwind
 * sweeps (Rouy and Tourin 1992), up to 3 voxels.
 */
#ifndef HOODOO_FIELD_H
#define HOODOO_FIELD_H

#include "gpu/gpu.h"
#include "particles/frame.h"
#include "particles/particles.h"

/* A plane along which pictures cut the rock: what is on one side of it is not shown, and the values inside show on the cut. */
enum cut_keeps { CUT_NONE, CUT_LOW, CUT_HIGH };
struct field_cut {
    enum cut_keeps keeps; /* the side that is shown: below or above `at` on the axis */
    int axis;             /* 0..2 */
    double at;            /* m */
};

/* Voxels on each side of a cut in which the values on it need particles. */
enum { CUT_REACH = 3 };

/* Do the samples first..last along an axis come within CUT_REACH of the cut? `origin`, m: position of sample 0. */
bool field_cut_near(const struct field_cut *cut, int axis, double origin, double voxel, int first, int last);

struct field {
    int n[3];                /* samples: the domain plus FIELD_MARGIN voxels on each side */
    double voxel, origin[3]; /* m: the particle spacing; position of sample 0 */
    /* Samples are stored in bricks (particles/grids.h) in and near rock. Elsewhere share and means are 0 and the distance is
     * +FIELD_BAND voxels; where the slot is BRICK_INSIDE the share is 1 and the distance -FIELD_BAND voxels. */
    size_t n_bricks, room; /* stored bricks; capacity */
    bool whole;            /* all rock has particles: no brick is BRICK_INSIDE */
    struct field_cut cut;  /* bricks at the cut are stored; set by the caller before the field is built */
    /* Per brick of the lattice, uint: */
    struct gpu_buffer *slot;         /* index in `list` plus 1; 0: not stored; or BRICK_INSIDE */
    struct gpu_buffer *list;         /* numbers of the stored bricks, ascending */
    struct gpu_buffer *held, *place; /* scratch */
    /* Per stored sample, [n_bricks * 512]: */
    struct gpu_buffer *share; /* float: of rock, 0..1 */
    /* vec4: stress (Pa), von Mises (Pa), viability, share of deposits; 0: no particle near */
    struct gpu_buffer *means;
    struct gpu_buffer *distance, *other; /* float: m, negative inside, at most 3 voxels; scratch */
};

/* HEAP_SWEEPS: smoothing sweeps over the columns of heaps, an even number. They distribute a voxel over a few of its neighbours. */
enum { FIELD_MARGIN = 4, FIELD_BAND = GRID_BAND, FIELD_MEANS = 4, HEAP_SWEEPS = 24 };

/* Device memory for so many stored samples, bytes. */
uint64_t field_bytes(const int voxels[3], uint64_t samples);
MUST_USE status field_create(struct gpu *gpu, const int voxels[3], double h, struct field *out);
void field_destroy(struct gpu *gpu, struct field *f);

/* Builds the field from the particles, whose stress must be current. `repose_deg`: angle of repose of deposits; their heaps are smoothed to
 * be no steeper, independently of voxels (shaders/field/heap.glsl). 0: there are no deposits. Moving rock is not smoothed. Waits for the
 * device, for the number of bricks. E_MEMORY. */
MUST_USE status field_build(struct gpu *gpu, struct gpu_work *work, struct field *f, struct particles *p,
                            double repose_deg);

/* A given share of rock in host memory: 0..1, 1/2 on the surface. All bricks must be stored that have samples which differ from a neighbour,
 * or are within 3 voxels of one that does. */
struct field_share {
    size_t n_bricks;
    const uint32_t *number, *slot; /* as in struct grid_bricks */
    const float *share;            /* [n_bricks * 512]; 0 beyond the lattice */
};

/* The same from a given share; the particles only provide the averages. Waits for the device. */
MUST_USE status field_build_share(struct gpu *gpu, struct field *f, struct particles *p,
                                  const struct field_share *known);

/* Uploads the field of a frame read from files: surface, stress, von_mises, viability and deposit from its grids; missing ones become 0.
 * E_INPUT: the grids have another lattice, or there is no surface. */
MUST_USE status field_upload(struct gpu *gpu, struct field *f, const struct frame_grids *grids);

/* Makes the buffers large enough for n bricks. If they have to grow, samples are lost. E_MEMORY. */
MUST_USE status field_keep(struct gpu *gpu, struct field *f, size_t n);

/* Writes to `other` the average of a particle value over nearby surface particles. Records only. */
void field_skin(struct gpu *gpu, struct field *f, const struct particles *p, enum value_id which);

/* Writes to `other` the average of a component of a particle vector over all nearby particles. Records only. */
void field_around(struct gpu *gpu, struct field *f, const struct particles *p, enum value_id which,
                  int component);

/* The component of `means` that holds a value; -1: none. */
int field_mean(enum value_id value);

/* Writes to `other` one of the means (field_mean()). Records only. */
void field_one_mean(struct gpu *gpu, struct field *f, int component);

/* Lists the volume grids of all values that the field and the particles provide, given what the frame `has` (HAS_*, values.def), in the
 * field's bricks and without samples. Free with frame_grids_free(). Waits for the device. E_MEMORY. */
MUST_USE status field_grids(struct gpu *gpu, const struct field *f, unsigned has, struct frame_grids *out);

/* The samples of one of these grids: [n_bricks * 512], of vectors three each. Uses `other`. Waits for the device. E_MEMORY. */
MUST_USE status field_read(struct gpu *gpu, struct field *f, const struct particles *p, enum value_id which,
                           float *out);

#endif
