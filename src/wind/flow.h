/* Air flow around the rock: divergence-free SPH (Bender and Koschier 2015) with the rock as boundary (Akinci et al. 2012),
 * in a box that the wind blows through. README.md has the equations.
 *
 * Units      Lengths are in spacings of the air's particles, velocities in wind speeds, times in spacing / wind speed. The
 *            viscosity is given in these units, so one flow holds for every wind speed.
 * Box        A whole number of spacings, centred on the rock's domain in x and y, on the ground in z. The wind's direction is
 *            projected to the horizontal: nothing passes the ground.
 * Sides      In a skin one kernel support wide along the sides and the top, air moves with the wind. Particles that leave the
 *            box are removed; new ones enter as planes of a lattice that the wind carries.
 * Start      Potential flow around the rock, on the cells of the box.
 * Average    Over blocks of steps. After each block the error of the average is estimated; the run ends once it is small
 *            enough. The pressure solves have fixed numbers of iterations.
 */
#ifndef HOODOO_FLOW_H
#define HOODOO_FLOW_H

#include <stdbool.h>

#include "gpu/gpu.h"
#include "gpu/primitives.h"
#include "job/job.h"
#include "particles/particles.h"

/* State in checkpoints besides the arrays. */
struct flow_state {
    double offset[2];    /* of the emitted lattice, in spacings: 0 to 1 */
    double direction[2]; /* unit vector of the last run's wind; 0 0: not run yet */
    double weight;       /* of the average, in steps */
    uint32_t n;          /* particles, boundary included */
    uint32_t next_id;
    uint64_t steps;
};

/* Statistics of the last run. */
struct flow_report {
    int steps;
    uint32_t n_air, n_rock;    /* particles of each */
    uint32_t n_in, n_out;      /* particles of air that entered and left during the run */
    double compression, error; /* mean over free air of max(0, density - 1), and of |density - 1| */
    double divergence;         /* mean of |div v| dt: relative change of volume in a step */
    double fastest;            /* in wind speeds */
    double unsettled;          /* estimated error of the average near the rock, as a share of its speed */
};

struct flow {
    int box[3];       /* spacings */
    double spacing;   /* m */
    double origin[2]; /* m: the box's low corner in the rock's domain */
    int cells[3];     /* of the neighbour search */
    size_t slots;
    int density_iterations, divergence_iterations;
    double viscosity;
    struct flow_state state;
    struct flow_report report;
    /* Particles, sorted by cell: [0] current, [1] scratch. [slots] */
    struct gpu_buffer *position[2], *velocity[2], *density_pressure[2], *divergence_pressure[2], *id[2];
    struct gpu_buffer *key, *start, *order, *taken, *unordered;
    struct gpu_buffer *list, *of_step, *viscous, *crowd, *push;
    /* Over the box, numbered (k ny + j) nx + i. */
    struct gpu_buffer *surface, *surface_sums, *flags, *place, *surface_list;
    struct gpu_buffer *sums;  /* vec4: the average, of velocities and of weights by the kernel */
    struct gpu_buffer *block; /* vec4: the same sums over the samples of the current block */
    int samples;
    struct gpu_buffer *squares;
    struct gpu_buffer *mean; /* vec4: averaged velocity in wind speeds, and share of air, at cell centres */
    struct gpu_buffer *counts;
    struct gpu_work *work;
};

/* Computes box, spacing and capacity for a job without creating buffers. E_USAGE if there would be too many particles. */
MUST_USE status flow_layout(const struct job *job, const int voxels[3], struct flow *out);
uint64_t flow_bytes(const struct flow *layout);       /* on the device */
uint64_t flow_state_bytes(const struct flow *layout); /* of a checkpoint, at most */

MUST_USE status flow_create(struct gpu *gpu, const struct job *job, const int voxels[3], struct flow *out);
void flow_destroy(struct gpu *gpu, struct flow *f);

/* *share: how much of the rock's surface, at the air's spacing, has changed since the last run, as a share of its cells; 1
 * before the first run. Needs the surface and normals of *p. Waits for the device. */
MUST_USE status flow_change(struct gpu *gpu, struct flow *f, struct particles *p, double *share);

/* Runs the flow towards `direction` (horizontal unit vector) around the rock of the last flow_change(), until the estimated
 * error of the average is at most `settled` (0: never), but for no more than `most` steps. Continues from the air of the last
 * run, or from potential flow if there is none or the wind has turned by more than 18 degrees. Fills report and mean. Waits for
 * the device. E_NUMERIC if a speed or density is not finite or particles find no slot. */
MUST_USE status flow_run(struct gpu *gpu, struct flow *f, struct particles *p, const double direction[2],
                         int most, double settled);

/* Number of steps in which the wind crosses the box once. */
int flow_flush(const struct flow *f, const double direction[2]);

/* The state as arrays for checkpoints: n items of each buffer. */
struct flow_array {
    const char *name;
    struct gpu_buffer *buffer;
    size_t n;
    bool words;         /* uint, else float */
    double range[4][2]; /* limits of each component in a valid checkpoint: far beyond what occurs */
};
enum { FLOW_ARRAYS = 7 };
void flow_arrays(const struct flow *f, struct flow_array out[FLOW_ARRAYS]);

/* E_CHECKPOINT if f->state, read from a checkpoint, is not one of this box. Call before flow_arrays(). */
MUST_USE status flow_check(const struct flow *f);

/* Computes `mean` after state and arrays have been restored. Records only. */
void flow_restore(struct gpu *gpu, struct flow *f);

#endif
