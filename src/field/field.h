/* The surface field: the rock as a signed distance on a lattice, with what its particles carry.
 *
 * Not Zhu and Bridson's mean of spheres but the rock's share of space, smoothed over a voxel and a half, cut
 * at 1/2: on a plane face it lies exactly where the particles' fill (their viability) puts it, so that the
 * surface moves smoothly while they weather and encloses their volume; and it does not show where in their
 * voxels the particles lie. The distance follows from that surface by upwind sweeps (Rouy and Tourin 1992)
 * out to 3 voxels.
 */
#ifndef HOODOO_FIELD_H
#define HOODOO_FIELD_H

#include "gpu/gpu.h"
#include "particles/frame.h"
#include "particles/particles.h"

struct field {
    int n[3];                /* samples: the domain and FIELD_MARGIN voxels around */
    double voxel, origin[3]; /* m: the particle spacing; sample 0 */
    /* Samples are kept in the bricks (particles/grids.h) that rock is in or near; elsewhere the share and the means are 0, and
     * the distance is that of the band's end. Where the slot is BRICK_INSIDE the share is 1, and the distance the other end's. */
    size_t n_bricks, room; /* bricks kept, and those there is room for */
    bool whole;            /* all rock has particles, and is kept and shown as they have it */
    struct gpu_buffer
        *slot; /* uint [bricks of the lattice]: place in the list and one more, 0, or BRICK_INSIDE */
    struct gpu_buffer *list;         /* uint [bricks of the lattice]: numbers, ascending */
    struct gpu_buffer *held, *place; /* scratch, likewise */
    struct gpu_buffer *share;        /* float [n_bricks * 512]: of rock, 0..1 */
    struct gpu_buffer *
        means; /* vec4 [n_bricks * 512]: stress (Pa), von Mises (Pa), viability, share of deposits; 0 where no
                   * particle is near */
    struct gpu_buffer *distance, *other; /* float [n_bricks * 512]: m, negative inside, at most 3 voxels */
};

/* HEAP_SWEEPS: over the columns of heaps, an even number. A voxel more or less spreads over a few of its neighbours. */
enum { FIELD_MARGIN = 4, FIELD_BAND = GRID_BAND, FIELD_MEANS = 4, HEAP_SWEEPS = 24 };

/* Bytes on the device, with so many samples kept. */
uint64_t field_bytes(const int voxels[3], uint64_t samples);
MUST_USE status field_create(struct gpu *gpu, const int voxels[3], double h, struct field *out);
void field_destroy(struct gpu *gpu, struct field *f);

/* From the particles, whose stress must be current. `repose_deg`: where there are deposits, the angle at which they lie. Their
 * heaps are shown smooth and no steeper, whatever the voxels of their particles (shaders/field/heap.glsl); 0: there are none. Where
 * rock is in motion they are shown as their particles lie.
 * Waits, to know how many bricks there are. */
MUST_USE status field_build(struct gpu *gpu, struct gpu_work *work, struct field *f, struct particles *p,
                            double repose_deg);

/* A rock's share that is known (host memory): 0..1, 1/2 on the surface. Kept are all bricks with samples that differ from a
 * neighbour, or are within 3 voxels of one that does. */
struct field_share {
    size_t n_bricks;
    const uint32_t *number, *slot; /* as in struct grid_bricks */
    const float *share;            /* [n_bricks * 512]; 0 beyond the lattice */
};

/* The same from this; the particles only say what lies near it. Waits. */
MUST_USE status field_build_share(struct gpu *gpu, struct field *f, struct particles *p,
                                  const struct field_share *known);

/* The field of a frame that was written: surface, stress, von_mises, viability and deposit from its grids, what
 * is missing being 0. E_INPUT: the grids are not of this lattice, or there is no surface among them. */
MUST_USE status field_upload(struct gpu *gpu, struct field *f, const struct frame_grids *grids);

/* Room on the device for n bricks. What was in the samples is lost where there was less
 * room. */
MUST_USE status field_keep(struct gpu *gpu, struct field *f, size_t n);

/* The mean of a value of the particles over those at the surface goes to `other`. Records only. */
void field_skin(struct gpu *gpu, struct field *f, struct particles *p, enum value_id which);

/* The mean of one component of a vector of the particles over all of them around goes to `other`. Records only. */
void field_around(struct gpu *gpu, struct field *f, struct particles *p, enum value_id which, int component);

/* Which of the means' four components a value is; -1 if it is none. */
int field_mean(enum value_id value);

/* The grids of the volumes that come of the particles, of a frame that `has` (HAS_*) what they need (values.def), in the
 * field's bricks. frame_grids_free(). Waits. */
MUST_USE status field_download(struct gpu *gpu, struct field *f, struct particles *p, unsigned has,
                               struct frame_grids *out);

#endif
