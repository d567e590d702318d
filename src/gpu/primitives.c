#include "gpu/primitives.h"

#include <assert.h>
#include <stdlib.h>

#include "base/memory.h"

enum { LEVELS_MAX = 8, WORDS = 64 };

struct gpu_work {
    struct gpu_buffer *sums[LEVELS_MAX]; /* per level: sums of the groups of the level below */
    int n_levels;
    size_t n_max;
    struct gpu_buffer *partial, *words;
};

static size_t runs(size_t n)
{
    return (n + SCAN_RUN - 1) / SCAN_RUN;
}

uint64_t gpu_work_bytes(size_t n_max)
{
    uint64_t bytes = REDUCE_THREADS * 4 + WORDS * 4;
    for (size_t n = runs(n_max + 1);; n = runs(n)) {
        bytes += n * 4;
        if (n == 1)
            return bytes;
    }
}

status gpu_work_create(struct gpu *gpu, size_t n_max, struct gpu_work **out)
{
    status st = OK;
    struct gpu_work *w = NULL;
    TRY(memory_alloc(1, sizeof *w, "scratch", &w));
    w->n_max = n_max + 1;
    for (size_t n = runs(w->n_max);; n = runs(n)) {
        TRY(gpu_buffer_create(gpu, "scan sums", n, 4, &w->sums[w->n_levels++]));
        if (n == 1)
            break;
    }
    TRY(gpu_buffer_create(gpu, "partial sums", REDUCE_THREADS, 4, &w->partial));
    TRY(gpu_buffer_create(gpu, "words", WORDS, 4, &w->words));
    *out = w;
    w = NULL;
done:
    gpu_work_destroy(gpu, &w);
    return st;
}

void gpu_work_destroy(struct gpu *gpu, struct gpu_work **work)
{
    struct gpu_work *w = *work;
    if (!w)
        return;
    for (int i = 0; i < w->n_levels; i++)
        gpu_buffer_destroy(gpu, &w->sums[i]);
    gpu_buffer_destroy(gpu, &w->partial);
    gpu_buffer_destroy(gpu, &w->words);
    free(w);
    *work = NULL;
}

struct gpu_buffer *gpu_work_words(struct gpu_work *work)
{
    return work->words;
}

static void scan_level(struct gpu *gpu, struct gpu_work *work, struct gpu_buffer *values, size_t n, int level)
{
    struct scan_params k = {.n = (uint32_t)runs(n), .n_values = (uint32_t)n};
    struct gpu_buffer *sums = work->sums[level];
    if (n > 1) {
        GPU_RUN(gpu, gpu_scan_sum, k.n, k, values, sums);
        scan_level(gpu, work, sums, k.n, level + 1);
        GPU_RUN(gpu, gpu_scan_apply, k.n, k, values, sums, values);
    } else {
        gpu_fill(gpu, values, 0);
    }
}

void gpu_scan(struct gpu *gpu, struct gpu_work *work, struct gpu_buffer *values, size_t n)
{
    assert(n <= work->n_max);
    if (n > 1)
        scan_level(gpu, work, values, n, 0);
    else
        gpu_fill(gpu, values, 0);
}

void gpu_sort(struct gpu *gpu, struct gpu_work *work, const struct gpu_sort *s)
{
    struct count_params k = {(uint32_t)s->n};
    struct sort_params rank = {(uint32_t)s->n, (uint32_t)s->n_ordered};
    gpu_fill(gpu, s->start, 0);
    gpu_fill(gpu, s->taken, 0);
    GPU_RUN(gpu, gpu_sort_count, s->n, k, s->keys, s->start);
    gpu_scan(gpu, work, s->start, s->n_keys + 1);
    GPU_RUN(gpu, gpu_sort_scatter, s->n, k, s->keys, s->start, s->taken, s->unordered);
    GPU_RUN(gpu, gpu_sort_rank, s->n, rank, s->keys, s->start, s->unordered, s->ids, s->order);
}

void gpu_gather(struct gpu *gpu, struct gpu_buffer *order, struct gpu_buffer *from, struct gpu_buffer *to,
                size_t n)
{
    struct count_params k = {(uint32_t)n};
    if (gpu_buffer_item(from) == 16)
        GPU_RUN(gpu, gpu_gather_v, n, k, order, from, to);
    else
        GPU_RUN(gpu, gpu_gather_u, n, k, order, from, to);
}

status gpu_compact(struct gpu *gpu, struct gpu_work *work, struct gpu_buffer *flags, struct gpu_buffer *place,
                   struct gpu_buffer *list, size_t n, size_t *n_list)
{
    status st = OK;
    struct count_params k = {(uint32_t)n};
    uint32_t total = 0, last = 0;
    if (n == 0) {
        *n_list = 0;
        return OK;
    }
    gpu_copy(gpu, place, flags, n);
    gpu_scan(gpu, work, place, n);
    GPU_RUN(gpu, gpu_compact, n, k, flags, place, list);
    TRY(gpu_download(gpu, place, n - 1, &total, 1));
    TRY(gpu_download(gpu, flags, n - 1, &last, 1));
    *n_list = total + (last != 0);
done:
    return st;
}

static void reduce(struct gpu *gpu, struct gpu_work *work, struct gpu_buffer *values, size_t n, bool maximum)
{
    struct reduce_params k = {REDUCE_THREADS, (uint32_t)n};
    if (maximum)
        GPU_RUN(gpu, gpu_reduce_max, REDUCE_THREADS, k, values, work->partial);
    else
        GPU_RUN(gpu, gpu_reduce_sum, REDUCE_THREADS, k, values, work->partial);
}

struct gpu_buffer *gpu_partial_sums(struct gpu *gpu, struct gpu_work *work, struct gpu_buffer *values,
                                    size_t n)
{
    reduce(gpu, work, values, n, false);
    return work->partial;
}

void gpu_sum(struct gpu *gpu, struct gpu_work *work, struct gpu_buffer *values, size_t n,
             struct gpu_buffer *scalars, uint32_t slot)
{
    struct reduce_end_params k = {64, 0, slot};
    reduce(gpu, work, values, n, false);
    GPU_RUN(gpu, gpu_reduce_end, 64, k, work->partial, scalars);
}

void gpu_max(struct gpu *gpu, struct gpu_work *work, struct gpu_buffer *values, size_t n,
             struct gpu_buffer *scalars, uint32_t slot)
{
    struct reduce_end_params k = {64, 1, slot};
    reduce(gpu, work, values, n, true);
    GPU_RUN(gpu, gpu_reduce_end, 64, k, work->partial, scalars);
}

status gpu_double_pointers(struct gpu *gpu, struct gpu_work *work, struct gpu_buffer *pointer,
                           struct gpu_buffer *other, size_t n)
{
    status st = OK;
    struct count_params k = {(uint32_t)n};
    uint32_t changed = 1;
    /* Two passes per round, so that the result ends in `pointer`. 32 rounds suffice for chains of 2^64 items. */
    for (int round = 0; changed && round < 32; round++) {
        gpu_fill(gpu, work->words, 0);
        GPU_RUN(gpu, gpu_double, n, k, pointer, other, work->words);
        GPU_RUN(gpu, gpu_double, n, k, other, pointer, work->words);
        TRY(gpu_download(gpu, work->words, 0, &changed, 1));
    }
    assert(!changed);
done:
    return st;
}
