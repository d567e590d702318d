/* A rehearsal measures how long a job will take: it simulates the job's first frames, encodes their files in memory, and discards
 * them. `hoodoo plan` bases its times on this, because some costs are not known in advance: the number of steps that water and wind
 * divide a frame into, the duration of slides, and the iterations of the stress solver.
 */
#ifndef HOODOO_REHEARSAL_H
#define HOODOO_REHEARSAL_H

#include "gpu/gpu.h"
#include "job/job.h"

/* s: CPU time, summed over all cores (it includes the device's time where the device is the CPU), and elapsed time. */
struct cost {
    double cpu, wall;
};

/* Kinds of files that a frame may have: JOB_POINTS, JOB_VOLUMES and JOB_PICTURES are the bits of such a set. */
enum { REHEARSAL_SETS = 8 };

/* The elapsed time of `c`, in s. Where the device is the CPU, it is the time that an idle machine would take, so that a plan does not
 * depend on what else is running. */
double cost_seconds(const struct gpu *gpu, struct cost c);

struct rehearsal {
    struct frame_range frames; /* the frames simulated, from the job's first */
    double n_particles;        /* by the job's estimate */
    struct cost start;         /* up to the first frame, with compiling kernels and other one-time costs */
    struct cost *each; /* [frames.last - frames.first]: the step to each frame after the first; owned */
    size_t n_each, capacity;
    struct cost step;       /* the expected step to each later frame */
    struct cost checkpoint; /* one checkpoint */
    /* By set of files, for a frame that has these files: measured at the first [0] and last [1] of `frames`. 0 where the job has no
     * frame with that set. */
    struct cost made[2][REHEARSAL_SETS];    /* making the frame, on the device */
    struct cost written[2][REHEARSAL_SETS]; /* writing it, while the next frame is made */
};

/* Rehearses two steps, and more until `patience` seconds are spent. The job must fit into memory (run/memory.h). Logs nothing.
 * Fails as the first frames of a run would, including E_NUMERIC and E_MEMORY. */
MUST_USE status rehearse(struct gpu *gpu, const struct job *job, double patience, struct rehearsal *out);

void rehearsal_free(struct rehearsal *r);

/* Corrects the expected later steps of `r` by the ratio of later to first steps seen in `longer`, a rehearsal of the same job with
 * fewer particles and more frames. */
void rehearsal_correct_steps(struct rehearsal *r, const struct rehearsal *longer);

/* The expected cost of the whole job. */
struct cost rehearsal_total(const struct rehearsal *r, const struct job *job);

/* Extrapolates to n_particles from rehearsals `a` and `b` of fewer particles, with a power law for each part. */
void rehearsal_scale(const struct rehearsal *a, const struct rehearsal *b, double n_particles,
                     struct rehearsal *out);

#endif
