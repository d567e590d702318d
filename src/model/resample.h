/* A state at another spacing: a branch may go on from a checkpoint at a whole fraction or a whole multiple of its spacing
 * (src/resample/README.md). */
#ifndef HOODOO_MODEL_RESAMPLE_H
#define HOODOO_MODEL_RESAMPLE_H

#include "checkpoint/checkpoint.h"
#include "job/job.h"

/* Replaces the sections of *c by those of the same state at the job's spacing; a checkpoint of that spacing stays as it is. *was_m: the
 * spacing that it had, m. E_CHECKPOINT: the
 * checkpoint is damaged or of another model or domain; the spacings' ratio is not a whole number up to RESAMPLE_MOST; rock is in motion; or
 * the model cannot do it. E_MEMORY. Errors of scene_sample(). */
MUST_USE status model_resample(const struct job *job, struct checkpoint *c, double *was_m);

#endif
