/* A rehearsal: the first frames of a job, simulated, made into files in memory and dropped, for what they take of time. What a plan's
 * time rests on: how many steps water and wind cut a frame into, how long slides last and how many iterations stress takes,
 * nobody knows before.
 */
#ifndef HOODOO_REHEARSAL_H
#define HOODOO_REHEARSAL_H

#include "gpu/gpu.h"
#include "job/job.h"

/* s: of all processors together (where the device is the CPU, its time is among it), and as they pass. */
struct cost {
    double cpu, wall;
};

/* Kinds of files that a frame may have: JOB_POINTS, JOB_VOLUMES and JOB_PICTURES are bits of such a set. */
enum { REHEARSAL_SETS = 8 };

/* What of it a plan's patience pays for: the time that passes; where the device is the CPU, as it would pass on an idle machine, so that a
 * plan comes out alike beside other work. */
double cost_seconds(const struct gpu *gpu, struct cost c);

struct rehearsal {
    struct frame_range frames; /* simulated, the first of the job among them */
    double n_particles;        /* what the job's estimate says */
    struct cost
        start; /* up to the first frame; kernels that had to be made, and what else only the first frames do */
    struct cost
        *each; /* [frames.last - frames.first]: the step to each frame after the first; rehearsal_free() */
    size_t n_each, capacity;
    struct cost step;       /* to each frame after those */
    struct cost checkpoint; /* one */
    /* Of a frame with such files, as the first and the last of `frames` take it; 0 where the job has no such frame. */
    struct cost made[2][REHEARSAL_SETS];    /* on the device */
    struct cost written[2][REHEARSAL_SETS]; /* and what is done while the next is made */
};

/* Rehearses two steps, and more as long as `patience` (s) is not spent. The job must fit (run/room.h). Says nothing in the log.
 * Whatever a run's first frames could say, E_NUMERIC and E_MEMORY among it. */
MUST_USE status rehearse(struct gpu *gpu, const struct job *job, double patience, struct rehearsal *out);

void rehearsal_free(struct rehearsal *r);

/* Steps after those rehearsed are to those as they were in a longer rehearsal of the same job with fewer particles. */
void rehearsal_follow(struct rehearsal *r, const struct rehearsal *longer);

/* What the whole job takes by it. */
struct cost rehearsal_total(const struct rehearsal *r, const struct job *job);

/* What a job with so many particles would have taken at its rehearsal, if every part grows as it did from `a` to `b`. */
void rehearsal_scale(const struct rehearsal *a, const struct rehearsal *b, double n_particles,
                     struct rehearsal *out);

#endif
