/* Exfoliation: bare rock sheds its skin in sheets, the same share of what is left of it in the same time, whatever the wind. What
 * never erodes sheds nothing, and deposits have no skin. */
#ifndef HOODOO_EXFOLIATION_H
#define HOODOO_EXFOLIATION_H

#include "gpu/gpu.h"
#include "job/job.h"
#include "particles/particles.h"

struct exfoliation {
    struct gpu_buffer *shed; /* float [n_max]: what the last step took, in the order of particles.surface */
};

/* Does the job, without its edits, have any? */
bool exfoliation_wanted(const struct job *job);

uint64_t exfoliation_bytes(size_t n);
MUST_USE status exfoliation_create(struct gpu *gpu, size_t n_max, struct exfoliation *out);
void exfoliation_destroy(struct gpu *gpu, struct exfoliation *e);

/* Takes from the surface's viability what comes off in so many thousand years, but never all. Records only. */
void exfoliation_step(struct gpu *gpu, struct exfoliation *e, const struct job *job, int frame, double kyr,
                      struct particles *p);

#endif
