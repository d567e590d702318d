/* Sheeting: exfoliation, sheets that come off faces where the rock is in tension. README.md in this folder has the law.
 *
 * When which sheet comes off is a function of place and time, so that there is no state. What it takes is an intensity among those of
 * wind and water, and counts with the blocks that fall.
 */
#ifndef HOODOO_SHEETING_H
#define HOODOO_SHEETING_H

#include <stdbool.h>

#include "gpu/gpu.h"
#include "job/job.h"
#include "particles/particles.h"

/* Does any come off, as the job is? */
bool sheeting_wanted(const struct job *job);

/* Adds to intensity and parts (of the surface's particles, in the order of p->surface) what comes off in a step that begins `from`
 * kyr after the first frame and takes `kyr`. Needs stress and erodibility of the current shape. Records only. */
void sheeting_press(struct gpu *gpu, const struct job *job, double from, double kyr, struct particles *p,
                    struct gpu_buffer *intensity, struct gpu_buffer *parts);

#endif
