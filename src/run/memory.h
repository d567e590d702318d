/* Does a job fit into the memory that is available, and if not, at which spacing would it? */
#ifndef HOODOO_RUN_MEMORY_H
#define HOODOO_RUN_MEMORY_H

#include "gpu/gpu.h"
#include "model/model.h"

/* Bytes of device memory and of host memory. Where the device is the CPU, everything is counted as host memory. */
struct run_memory {
    uint64_t device, host;
};

/* What is available now. */
struct run_memory run_memory_available(const struct gpu *gpu);

/* Bytes of host memory that the process needs besides the job's own data: the program, its libraries, the device's driver and the
 * compiled kernels. Call it before using the device, since memory already resident is measured. `gpu` is NULL if no device is to be
 * opened. */
uint64_t run_memory_process(const struct gpu *gpu, const struct model_estimate *estimate);

/* What the job needs from now on at a pace; the least is at PACE_STREAM. Memory that the process already holds is not included. */
struct run_memory run_memory_needed(const struct gpu *gpu, const struct model_estimate *estimate,
                                    enum frame_pace pace);

/* The fastest pace that the estimate allows and for which there is memory; PACE_STREAM if there is none. */
enum frame_pace run_memory_pace(const struct gpu *gpu, const struct model_estimate *estimate);

bool run_memory_fits(struct run_memory available, struct run_memory needed);

/* E_MEMORY, with what is needed, what is available, and a spacing that would fit. *out is the job's estimate. */
MUST_USE status run_memory_check(const struct gpu *gpu, const struct job *job, struct model_estimate *out);

#endif
