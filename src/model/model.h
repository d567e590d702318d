/* A model: one of the published systems, as run, plan and the farm see it. arenite.c is the one to read
 * first. */
#ifndef HOODOO_MODEL_H
#define HOODOO_MODEL_H

#include "checkpoint/checkpoint.h"
#include "frame/disk.h"
#include "gpu/gpu.h"
#include "job/job.h"
#include "particles/frame.h"

struct model;

/* What a job will take, before anything is allocated. */
struct model_estimate {
    size_t n_particles;
    int voxels[3];
    uint64_t device_bytes;
    uint64_t host_bytes;    /* besides the device's, with frames waiting to be written */
    struct disk_frame disk; /* of a frame */
    uint64_t checkpoint_bytes;
    double steps; /* of erosion and equilibrium, over all frames */
};

struct model_type {
    const char *name;
    MUST_USE status (*estimate)(const struct job *job, struct model_estimate *out);

    /* The job's first frame; or, with `from`, the state that checkpoint holds. */
    MUST_USE status (*create)(struct gpu *gpu, const struct job *job, const struct checkpoint *from,
                              struct model **out);
    void (*destroy)(struct model **model);

    /* Simulates the next frame. E_NUMERIC when numbers blow up. */
    MUST_USE status (*step)(struct model *model);

    /* The frame the state is of. */
    int (*frame)(const struct model *model);

    /* What there is to write of this frame, in host memory: frame_free(). */
    MUST_USE status (*output)(struct model *model, struct frame *out);

    /* The state, as sections that *out owns: checkpoint_free(). Provenance is the caller's to fill in. */
    MUST_USE status (*save)(struct model *model, struct checkpoint *out);
};

/* The job's. */
const struct model_type *model_of(const struct job *job);

#endif
