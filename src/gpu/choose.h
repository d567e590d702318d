/* Which device --device selects. A pure function, so that tests can describe machines that do not exist. */
#ifndef HOODOO_GPU_CHOOSE_H
#define HOODOO_GPU_CHOOSE_H

#include "gpu/gpu.h"

/* *chosen is the index into `info` of the device that `wanted` (gpu_options.device, or NULL) selects. `slurm_gpus`: the value of
 * SLURM_STEP_GPUS, else of SLURM_JOB_GPUS, else NULL. E_DEVICE: there is no such device; the message lists the devices. E_USAGE:
 * `wanted` is not a valid selection. */
MUST_USE status gpu_choose(const char *wanted, const char *slurm_gpus, const struct gpu_info *info, size_t n,
                           size_t *chosen);

#endif
