/* A model: one of the published systems, as run, plan and the farm see it. The key `model` says which one a job has.
 *
 * Calling sequence   model_estimate(), without a device; model_create(), then model_output() and model_save() for the
 *                    frame its state is of, and model_step() to the next one.
 */
#ifndef HOODOO_MODEL_H
#define HOODOO_MODEL_H

#include "checkpoint/checkpoint.h"
#include "field/field.h"
#include "frame/disk.h"
#include "frame/host.h"
#include "gpu/gpu.h"
#include "job/job.h"
#include "particles/frame.h"

struct model;

/* What a job will take, before anything is allocated. */
struct model_estimate {
    size_t n_particles;
    int voxels[3];
    uint64_t device_bytes;
    enum frame_pace pace;    /* the fastest that output.memory_GB allows */
    uint64_t host_bytes;     /* besides the device's, at that pace */
    uint64_t host_at[PACES]; /* the same at each pace */
    struct disk_frame disk;  /* of one frame */
    uint64_t checkpoint_bytes;
    double steps; /* of erosion or equilibrium, over all frames */
    int kernels;  /* about how many different kernels run */
};

/* E_USAGE, E_INPUT: the scene or one of its files is wrong. E_USAGE: streamed frames take more than output.memory_GB. */
MUST_USE status model_estimate(const struct job *job, struct model_estimate *out);

/* Creates the model at the job's first frame or, if `from` is not NULL, in the state of that checkpoint; E_CHECKPOINT if the checkpoint
 * has another model or domain. `job` must outlive the model. Free with model_destroy(). */
MUST_USE status model_create(struct gpu *gpu, const struct job *job, const struct checkpoint *from,
                             struct model **out);
void model_destroy(struct model **model);

/* Simulates the next frame. E_NUMERIC if a number is not finite or runs away. */
MUST_USE status model_step(struct model *model);

/* The number of the current frame. */
int model_frame(const struct model *model);

/* Makes the current frame in host memory, with what the job writes of it. Free with frame_free(). */
MUST_USE status model_output(struct model *model, struct frame *out);

/* From now on model_output() leaves the samples of volumes on the device. They are read one grid at a time when the frame is written, which
 * must be before the model's next function is called. */
void model_stream(struct model *model);

/* Makes only the pictures of output.aov.cameras, in out->image, even if the job has no pictures of this frame. Their colours include the
 * level ground around the rock, opaque and with the rock's shadow; their other layers do not. The rock is cut at `cut` ({0}: not), where its
 * inside gets particles; this changes no later frame. Free with frame_free(). */
MUST_USE status model_pictures(struct model *model, const struct field_cut *cut, struct frame *out);

/* Makes only the numbers of the current frame: volumes, ledger, changes, greatest stress. */
MUST_USE status model_measure(struct model *model, struct frame *out);

/* Sets a function that is called when a stage of a frame begins; NULL: none. */
void model_on_stage(struct model *m, void (*begun)(void *user, int frame, const char *name), void *user);

/* Saves the state as sections that *out owns; free with checkpoint_free(). The caller fills in job_hash and maker. */
MUST_USE status model_save(struct model *model, struct checkpoint *out);

#endif
