/* Sheeting (exfoliation): sheets come off faces where the rock is in tension. README.md has the law.
 *
 * Which sheet comes off when is a function of place and time, so there is no state. It is added to the intensity of wind and water;
 * the budget counts it with the blocks that fall.
 */
#ifndef HOODOO_SHEETING_H
#define HOODOO_SHEETING_H

#include <stdbool.h>

#include "gpu/gpu.h"
#include "job/job.h"
#include "particles/particles.h"

/* Whether the job has sheeting (sheeting.per_kyr > 0). */
bool sheeting_wanted(const struct job *job);

/* Adds the sheets of a step of `kyr`, beginning `from` kyr after the first frame, to intensity and parts (both [n_surface], in the
 * order of p->surface; as in erosion.h). Needs stress and erodibility of the current shape. Records only. */
void sheeting_press(struct gpu *gpu, const struct job *job, double from, double kyr, struct particles *p,
                    struct gpu_buffer *intensity, struct gpu_buffer *parts);

#endif
