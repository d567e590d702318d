/* Room: does what a job takes fit into the memory there is, and at which spacing would it? */
#ifndef HOODOO_RUN_ROOM_H
#define HOODOO_RUN_ROOM_H

#include "gpu/gpu.h"
#include "model/model.h"

/* Bytes on the device, and of the machine's own memory, of which a CPU's device is part. */
struct room {
    uint64_t device, host;
};

/* What is free now. */
struct room room_free(const struct gpu *gpu);

/* What a run takes beside its job's own: the program, its libraries, the device's driver, compiled kernels. Before
 * the device is worked with: what is there is measured. `gpu` NULL: where there is no device to look at. */
uint64_t room_process(const struct gpu *gpu, const struct model_estimate *estimate);

/* What a job takes from here on: what the process has already is not free any more. At least: where a frame is written before the
 * next is made. */
struct room room_needed(const struct gpu *gpu, const struct model_estimate *estimate);

/* The same where one is written while the next is made. */
struct room room_at_once(const struct gpu *gpu, const struct model_estimate *estimate);

bool room_enough(struct room there, struct room needed);

/* E_MEMORY, with what is needed, what there is, and the spacing that would fit. *out is what the job takes. */
MUST_USE status room_check(const struct gpu *gpu, const struct job *job, struct model_estimate *out);

#endif
