/* Which device --device means. Pure, so that machines can be made up for tests. */
#ifndef HOODOO_GPU_CHOOSE_H
#define HOODOO_GPU_CHOOSE_H

#include "gpu/gpu.h"

/* The index into info of what `wanted` (gpu_options.device, or NULL) names. `slurm_gpus`: SLURM_STEP_GPUS, else
 * SLURM_JOB_GPUS, else NULL. E_DEVICE lists what is here; E_USAGE if `wanted` is not understood. */
MUST_USE status gpu_choose(const char *wanted, const char *slurm_gpus, const struct gpu_info *info, size_t n,
                           size_t *chosen);

#endif
