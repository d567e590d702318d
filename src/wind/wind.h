/* Wind erosion: deflation everywhere, abrasion where blown sand strikes (Arenite eqs. 7, 8, 12). README.md has the equations.
 *
 * Results are intensities: 1 makes bare, unstressed rock retreat at its weak rate.
 *
 *   wind_create -> wind_update, wind_erode in every step -> wind_destroy
 *
 * With wind.flow.solver: uniform the wind is the same everywhere and rock upwind shelters; with sph the air flows around the
 * rock (flow.h).
 */
#ifndef HOODOO_WIND_H
#define HOODOO_WIND_H

#include "gpu/gpu.h"
#include "job/job.h"
#include "particles/particles.h"
#include "wind/flow.h"

/* The wind far from the rock in a frame, turned and with gusts: unit direction it blows to, and speed in m/s. */
struct wind_at {
    double direction[3], speed;
};
struct wind_at wind_at(const struct job *job, int frame);

/* Largest retreat over the layers, m/kyr, of bare, unstressed rock that faces the wind. */
double wind_fastest(const struct job *job, int frame);

struct wind {
    bool flows; /* false: uniform wind, `flow` is unused */
    struct flow flow;
};

/* Whether the wind is a fluid (wind.flow.solver: sph), else uniform. */
bool wind_flows(const struct job *job);

/* E_USAGE if the flow would have too many particles. The sizes below are 0 then, and for uniform wind. */
MUST_USE status wind_check(const struct job *job, const int voxels[3]);
uint64_t wind_bytes(const struct job *job, const int voxels[3]);
uint64_t wind_checkpoint_bytes(const struct job *job, const int voxels[3]);

MUST_USE status wind_create(struct gpu *gpu, const struct job *job, const int voxels[3], struct wind *out);
void wind_destroy(struct gpu *gpu, struct wind *w);

/* Continues the flow if rock or direction have changed enough since its last run (wind.flow.rock_change, wind_change), and
 * logs the run. Does nothing for uniform wind. Needs the surface of the current shape. Waits for the device. E_NUMERIC as
 * flow_run(). */
MUST_USE status wind_update(struct gpu *gpu, struct wind *w, const struct job *job, int frame,
                            struct particles *p);

/* Sets intensity[i] = W of surface particle i (float [n_surface], in the order of p->surface) and parts[i] (uint) to
 * deflation's share in it; both and `layers` as in erosion.h. Needs surface, normals and stress of the current shape. Records
 * only. */
void wind_erode(struct gpu *gpu, const struct wind *w, const struct job *job, int frame, struct particles *p,
                struct gpu_buffer *layers, struct gpu_buffer *intensity, struct gpu_buffer *parts);

/* The averaged air around the rock: vec4 at the centres of n cells from `origin`, cell (i, j, k) at (k n_y + j) n_x + i:
 * velocity as a share of `speed`, and the share of the surroundings that is air. */
struct wind_lattice {
    struct gpu_buffer *velocity; /* not owned */
    int n[3];
    double origin[3], cell; /* m */
    double speed;           /* m/s */
};

/* false if there is no flow: uniform wind, or calm so far. */
bool wind_lattice(const struct wind *w, const struct job *job, int frame, struct wind_lattice *out);

#endif
