/* How much of the rock each process takes in a frame, exactly: viability in whole quanta (2^-31 of a particle),
 * summed as integers, so that the processes' changes add up to the frame's whatever the order.
 *
 * Calling sequence   budget_create(); in every frame budget_clear(), then around each process budget_sum() with
 *                    `after` false and true (erosion_weather() enters its own: wind and water by their share in
 *                    the intensity), then budget_read(). Records only, but for the last.
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

/* All rows: nothing has changed. */
void budget_clear(struct gpu *gpu, struct budget *b);

/* Adds the sum of n floats, viability from 0 to 1, to the row of a process, or takes it off it. */
void budget_sum(struct gpu *gpu, struct budget *b, enum process process, bool after,
                struct gpu_buffer *viability, size_t n);

/* Takes spent[i] quanta (uint [n]) off the rows of deflation, water and abrasion. parts[i]: the shares of the
 * first two (erosion/parts.glsl); where it is a deposit's, off that of reworking. */
void budget_split(struct gpu *gpu, struct budget *b, struct gpu_buffer *spent, struct gpu_buffer *parts,
                  size_t n);

/* What each process has changed since the rows were cleared, in quanta. Waits. */
MUST_USE status budget_read(struct gpu *gpu, const struct budget *b, int64_t quanta[PROCESSES]);

/* Quanta in m3, for particles that stand for h^3. */
double budget_m3(int64_t quanta, double h);

#endif
