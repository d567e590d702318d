/* The air around the rock as particles: divergence-free SPH (Bender and Koschier 2015) with the rock as
 * boundary (Akinci et al. 2012), in a box that the wind blows through.
 *
 * Units      Inside, lengths are in spacings of the air's particles and velocities in wind speeds: viscosity
 *            goes with both, so that the flow of one direction is the flow of every speed.
 * Box        Whole spacings, centred on the rock's domain in x and y, on the ground in z. The wind is laid
 *            flat: nothing passes the ground.
 * Sides      In a skin one support wide along the sides and the top, air moves with the wind. What leaves
 *            the box is gone; what comes in is the next plane of a lattice that the wind carries.
 * Start      Potential flow around the rock, on the cells of a lattice.
 * Average    Of blocks of steps. Each tells by how much the average may still be wrong; once that is little
 *            enough, the run ends. Iterations have fixed numbers.
 */
#ifndef HOODOO_FLOW_H
#define HOODOO_FLOW_H

#include <stdbool.h>

#include "gpu/gpu.h"
#include "gpu/primitives.h"
#include "job/job.h"
#include "particles/particles.h"

/* What a resumed run needs besides the arrays. */
struct flow_state {
    double offset[2];    /* of the emitted lattice, in spacings: 0 to 1 */
    double direction[2]; /* unit vector it last blew to; 0 0: not run yet */
    double weight;       /* steps that the average stands for */
    uint32_t n;          /* particles, boundary included */
    uint32_t next_id;
    uint64_t steps;
};

/* Of the last run. */
struct flow_report {
    int steps;
    uint32_t n_air, n_rock;    /* particles of each */
    uint32_t n_in, n_out;      /* that came in, and left, since the run began */
    double compression, error; /* mean over free air of max(0, density - 1), and of |density - 1| */
    double divergence;         /* mean of |div v| dt: the share of its volume it gains or loses in a step */
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
    /* Particles, in the order of cells: [0] as arranged, [1] scratch. Items: slots. */
    struct gpu_buffer *position[2], *velocity[2], *density_pressure[2], *divergence_pressure[2], *id[2];
    struct gpu_buffer *key, *start, *order, *taken, *unordered;
    struct gpu_buffer *list, *of_step, *viscous, *crowd, *push;
    /* Over the box, numbered (k ny + j) nx + i. */
    struct gpu_buffer *surface, *surface_sums, *flags, *place, *surface_list;
    struct gpu_buffer *sums;  /* vec4: the average, of velocities and of weights by the kernel */
    struct gpu_buffer *block; /* vec4: likewise sums of the samples since the last block */
    int samples;
    struct gpu_buffer *squares;
    struct gpu_buffer
        *mean; /* vec4: averaged velocity in wind speeds, and the share of air, at cell middles */
    struct gpu_buffer *counts;
    struct gpu_work *work;
};

/* Box and numbers of a job's air. E_USAGE if it would have too many particles. */
MUST_USE status flow_layout(const struct job *job, const int voxels[3], struct flow *out);
uint64_t flow_bytes(const struct flow *layout);
uint64_t flow_state_bytes(const struct flow *layout);

MUST_USE status flow_create(struct gpu *gpu, const struct job *job, const int voxels[3], struct flow *out);
void flow_destroy(struct gpu *gpu, struct flow *f);

/* The share of the rock's surface, at the air's spacing, that is elsewhere than in the last run; 1 before the
 * first. Waits. */
MUST_USE status flow_change(struct gpu *gpu, struct flow *f, struct particles *p, double *share);

/* Lets the wind blow to `direction` (horizontal, unit) around the rock of the last flow_change(): for so many
 * steps at most, and until the average's estimated error is no more than `settled` (0: all the steps). It goes on
 * from the air of the last run, or begins from potential flow if there is none or it blew elsewhere. Fills
 * report. Waits. E_NUMERIC. */
MUST_USE status flow_run(struct gpu *gpu, struct flow *f, struct particles *p, const double direction[2],
                         int most, double settled);

/* Steps that carry the wind once through the box. */
int flow_flush(const struct flow *f, const double direction[2]);

/* The state as arrays, in host memory: one at a time, n items of the buffer's size. */
struct flow_array {
    const char *name;
    struct gpu_buffer *buffer;
    size_t n;
    bool words;         /* uint, else float */
    double range[4][2]; /* least and most of each component that air can have: far beyond what it does have */
};
enum { FLOW_ARRAYS = 7 };
void flow_arrays(const struct flow *f, struct flow_array out[FLOW_ARRAYS]);

/* E_CHECKPOINT if a state that was put back cannot be one of this box; before flow_arrays(). */
MUST_USE status flow_check(const struct flow *f);

/* After the arrays have been put back, too. Records only. */
void flow_restore(struct gpu *gpu, struct flow *f);

#endif
