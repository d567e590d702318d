/* Wind on rock: deflation everywhere, abrasion where blown sand strikes (Arenite eqs. 7, 8, 12).
 *
 * Rates are intensities: 1 makes bare, unstressed rock retreat at its weak rate.
 *
 *   wind_create -> wind_update, wind_erode in every step -> wind_destroy
 *
 * With wind.flow.solver: uniform the wind is the same everywhere and rock upwind shelters; with sph it flows
 * around the rock (flow.h).
 */
#ifndef HOODOO_WIND_H
#define HOODOO_WIND_H

#include "gpu/gpu.h"
#include "job/job.h"
#include "particles/particles.h"
#include "wind/flow.h"

/* The wind far from the rock in a frame: unit direction and speed, m/s, gusts included. */
struct wind_at {
    double direction[3], speed;
};
struct wind_at wind_at(const struct job *job, int frame);

/* How fast bare, unstressed rock across the wind retreats in the layer where it does so fastest, m/kyr. */
double wind_fastest(const struct job *job, int frame);

struct wind {
    bool flows; /* else there is no flow */
    struct flow flow;
};

/* E_USAGE if the flow would have too many particles; wind_bytes() is 0 then. */
/* Whether the wind is a fluid, with a lattice of its own, or the same everywhere. */
bool wind_flows(const struct job *job);

MUST_USE status wind_check(const struct job *job, const int voxels[3]);
uint64_t wind_bytes(const struct job *job, const int voxels[3]);
uint64_t wind_checkpoint_bytes(const struct job *job, const int voxels[3]);

MUST_USE status wind_create(struct gpu *gpu, const struct job *job, const int voxels[3], struct wind *out);
void wind_destroy(struct gpu *gpu, struct wind *w);

/* Lets the flow run on if rock or direction have changed enough since it last did, and notes in the log that
 * it did. Needs the surface of the current shape. Waits. E_NUMERIC when numbers blow up. */
MUST_USE status wind_update(struct gpu *gpu, struct wind *w, const struct job *job, int frame,
                            struct particles *p);

/* intensity[i] = W of the surface's particle i (float [n_surface], in the order of p->surface), and parts[i] (uint)
 * deflation's share in it, as erosion.h has them, and `layers`. Needs surface and stress of the current shape. Records only. */
void wind_erode(struct gpu *gpu, const struct wind *w, const struct job *job, int frame, struct particles *p,
                struct gpu_buffer *layers, struct gpu_buffer *intensity, struct gpu_buffer *parts);

/* The averaged air around the rock: vec4 at the middles of n cells from `origin`, numbered (k n_y + j) n_x +
 * i: velocity as a share of `speed`, and the share of space that is air. */
struct wind_lattice {
    struct gpu_buffer *velocity;
    int n[3];
    double origin[3], cell; /* m */
    double speed;           /* m/s */
};

/* false if there is none: uniform, or calm so far. */
bool wind_lattice(const struct wind *w, const struct job *job, int frame, struct wind_lattice *out);

#endif
