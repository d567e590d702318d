#include "erosion/budget.h"

#include <math.h>
#include <stdlib.h>

#include "base/memory.h"

enum { WORDS = PROCESSES * BUDGET_LANES * 2 };

status budget_create(struct gpu *gpu, struct budget *b)
{
    status st = gpu_buffer_create(gpu, "the frame's budget", WORDS, 4, &b->sums);
    if (st == OK)
        budget_clear(gpu, b);
    return st;
}

void budget_destroy(struct gpu *gpu, struct budget *b)
{
    gpu_buffer_destroy(gpu, &b->sums);
}

void budget_clear(struct gpu *gpu, struct budget *b)
{
    gpu_fill(gpu, b->sums, 0);
}

void budget_sum(struct gpu *gpu, struct budget *b, enum process process, bool after,
                struct gpu_buffer *viability, size_t n)
{
    struct budget_params k = {.n = BUDGET_LANES, .n_values = (uint)n, .row = process, .after = after};
    GPU_RUN(gpu, erosion_budget_sum, k.n, k, viability, b->sums);
}

void budget_split(struct gpu *gpu, struct budget *b, struct gpu_buffer *spent, struct gpu_buffer *parts,
                  size_t n)
{
    struct budget_split_params k = {.n = BUDGET_LANES,
                                    .n_values = (uint)n,
                                    .deflation = PROCESS_DEFLATION,
                                    .water = PROCESS_WATER,
                                    .abrasion = PROCESS_ABRASION,
                                    .reworking = PROCESS_REWORKING,
                                    .sheets = PROCESS_BLOCKS};
    GPU_RUN(gpu, erosion_budget_split, k.n, k, spent, parts, b->sums);
}

status budget_read(struct gpu *gpu, const struct budget *b, int64_t quanta[PROCESSES])
{
    status st = OK;
    uint32_t *word = NULL;
    TRY(memory_alloc(WORDS, sizeof *word, "the frame's budget", &word));
    TRY(gpu_download(gpu, b->sums, 0, word, WORDS));
    for (size_t row = 0; row < PROCESSES; row++) {
        uint64_t sum = 0; /* in two's complement */
        for (size_t i = row * BUDGET_LANES; i < (row + 1) * BUDGET_LANES; i++)
            sum += word[2 * i] | (uint64_t)word[2 * i + 1] << 32;
        quanta[row] = (int64_t)sum;
    }
done:
    free(word);
    return st;
}

double budget_m3(int64_t quanta, double h)
{
    return (double)quanta * 0x1p-31 * pow(h, 3);
}
