/* The volume that each process removes or adds in a frame, exactly: viability in quanta (2^-31 of a particle), summed as
 * integers, so that the processes' changes add up to the frame's in whatever order they are summed.
 *
 * Calling sequence   budget_create(); in every frame budget_clear(); budget_sum() before each process with `after` false and
 *                    after it with `after` true; budget_read(). erosion_weather() enters its own volumes with budget_split(),
 *                    for wind and water by their share in the intensity. Only budget_read() waits for the device.
 */
#ifndef HOODOO_BUDGET_H
#define HOODOO_BUDGET_H

#include <stdbool.h>
#include <stdint.h>

#include "gpu/gpu.h"
#include "job/job.h"

struct budget {
    struct gpu_buffer *sums; /* uint [PROCESSES][BUDGET_LANES][2] */
};

MUST_USE status budget_create(struct gpu *gpu, struct budget *out);
void budget_destroy(struct gpu *gpu, struct budget *b);

/* Sets all rows to 0. */
void budget_clear(struct gpu *gpu, struct budget *b);

/* Adds the sum of n floats (viability, clamped to 0..1) to a process's row if `after`, else subtracts it. */
void budget_sum(struct gpu *gpu, struct budget *b, enum process process, bool after,
                struct gpu_buffer *viability, size_t n);

/* Subtracts spent[i] quanta (uint [n]) from the rows of the processes that parts[i] (erosion/parts.glsl) names: deflation,
 * water and abrasion by their shares, blocks for sheets, or reworking for deposits. */
void budget_split(struct gpu *gpu, struct budget *b, struct gpu_buffer *spent, struct gpu_buffer *parts,
                  size_t n);

/* Each process's change since budget_clear(), in quanta; negative: removed. Waits for the device. */
MUST_USE status budget_read(struct gpu *gpu, const struct budget *b, int64_t quanta[PROCESSES]);

/* Quanta to m3, for particles of volume h^3. */
double budget_m3(int64_t quanta, double h);

#endif
