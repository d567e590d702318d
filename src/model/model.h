/* A model: one of the published systems, as run, plan and the farm see it. The key `model` says which one a job has.
 *
 * Calling sequence   model_estimate(), without a device; model_create(), then model_output() and model_save() for the
 *                    frame its state is of, and model_step() to the next one.
 */
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
    uint64_t host_bytes;    /* besides the device's, with a frame that is written while the next is made */
    uint64_t waiting_bytes; /* of these: not taken where it is written first */
    bool turns;             /* it is, for output.memory_GB wants it so: host_bytes are without them */
    struct disk_frame disk; /* of a frame */
    uint64_t checkpoint_bytes;
    double steps; /* of erosion and equilibrium, over all frames */
    int kernels;  /* that it runs, about */
};

/* E_USAGE, E_INPUT: the scene is wrong, or a file of it; E_USAGE: output.memory_GB is less than one frame takes. */
MUST_USE status model_estimate(const struct job *job, struct model_estimate *out);

/* The job's first frame; or, with `from`, the state that checkpoint holds: E_CHECKPOINT if it is not one of this
 * model and domain. model_destroy(). */
MUST_USE status model_create(struct gpu *gpu, const struct job *job, const struct checkpoint *from,
                             struct model **out);
void model_destroy(struct model **model);

/* Simulates the next frame. E_NUMERIC when numbers blow up. */
MUST_USE status model_step(struct model *model);

/* The frame the state is of. */
int model_frame(const struct model *model);

/* What there is to write of this frame, in host memory: frame_free(). */
MUST_USE status model_output(struct model *model, struct frame *out);

/* Its pictures alone, in out->image, whichever frames the job has pictures of: those of output.aov.cameras. The level ground around the
 * rock, on which it throws its shadow, is in their colours: opaque, and nowhere in the other layers. frame_free(). */
MUST_USE status model_pictures(struct model *model, struct frame *out);

/* The state, as sections that *out owns: checkpoint_free(). Provenance is the caller's to fill in. */
MUST_USE status model_save(struct model *model, struct checkpoint *out);

#endif
