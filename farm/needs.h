/* What a task requests from a scheduler: cores, memory, a GPU, time. Every writer (Slurm, OpenJD, tasks as JSON) gets its requests here.
 *
 * Memory      The planned peak of the task's processes together, and a fifth more (NEEDS_MARGIN), as the plan is within 15 % of
 *             what a simulation takes (tests/cli/memory.py). Where the device is the CPU, its memory is part of the machine's.
 * Time limit  One and a half times the estimate of a simulation, three times that of all else, whose estimates are coarser; ten
 *             minutes more, and the notice. A task that reaches its limit has saved its frames and continues when it is started
 *             again, so that a limit that proves short costs a restart.
 * Notice      How long before its limit a task must be told: two frames and a minute, as a simulation saves between frames.
 * Job keys    farm.sim, farm.derive, farm.preview and farm.finish replace cores, memory and limit.
 */
#ifndef HOODOO_FARM_NEEDS_H
#define HOODOO_FARM_NEEDS_H

#include "farm/farm.h"

#define NEEDS_MARGIN 1.2

enum { NEEDS_NOTICE_S = 180 }; /* the shortest notice */

struct farm_needs {
    int cpus;
    char cpus_text[12]; /* the same as text, for --jobs */
    bool gpu;
    uint64_t gpu_bytes;    /* of the GPU's memory; 0 without one */
    uint64_t peak_bytes;   /* of the machine's memory, as planned */
    uint64_t memory_bytes; /* to request */
    double seconds;        /* estimate of the task's time; 0: not known */
    int64_t limit_s;       /* time limit to request; 0: none */
    int notice_s;
};

/* `device`: as for --device, or NULL for any. */
void farm_needs(const struct farm *f, const struct farm_task *t, const char *device, struct farm_needs *out);

/* The job's keys for tasks of this kind: farm.sim and so on. */
const struct job_tasks *farm_requests(const struct job *job, enum farm_kind kind);

/* Bytes in whole units of `unit`, rounded up, as schedulers count memory. */
int64_t farm_units(uint64_t bytes, uint64_t unit);

#endif
