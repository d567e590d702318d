#include "gpu/primitives.h"

#include <assert.h>
#include <stdlib.h>

#include "base/memory.h"
#include "gpu/internal.h"

/* BATCH_FIRST: rounds of a loop's first batch. */
enum { LEVELS_MAX = 8, WORDS = 64, FLAGS = 64, BATCH_FIRST = 4, DEPTH_MAX = 2 };

struct gpu_work {
    struct gpu_buffer *sums[LEVELS_MAX]; /* per level: sums of the groups of the level below */
    int n_levels;
    size_t n_max;
    struct gpu_buffer *partial, *words;
    struct gpu_buffer *flags[DEPTH_MAX]; /* of the rounds of a loop, and of the loop in it */
    int depth;
};

static size_t runs(size_t n)
{
    return (n + SCAN_RUN - 1) / SCAN_RUN;
}

uint64_t gpu_work_bytes(size_t n_max)
{
    uint64_t bytes = REDUCE_THREADS * 4 + WORDS * 4 + DEPTH_MAX * FLAGS * 4;
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
    for (int i = 0; i < DEPTH_MAX; i++)
        TRY(gpu_buffer_create(gpu, "flags of rounds", FLAGS, 4, &w->flags[i]));
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
    for (int i = 0; i < DEPTH_MAX; i++)
        gpu_buffer_destroy(gpu, &w->flags[i]);
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
    uint32_t total = 0;
    if (n == 0) {
        *n_list = 0;
        return OK;
    }
    gpu_copy(gpu, place, flags, n);
    gpu_scan(gpu, work, place, n);
    GPU_RUN(gpu, gpu_compact, n, k, flags, place, list, work->partial);
    TRY(gpu_download(gpu, work->partial, 0, &total, 1));
    *n_list = total;
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

/* Whether the batch that ends here was the last one. The host looks unless `most` rounds are known to suffice. */
static bool rounds_ended(struct gpu *gpu, struct gpu_rounds *r)
{
    uint32_t more = 0;
    if (gpu->st != OK || (r->bounded && gpu->conditions.begin))
        return true;
    r->st = gpu_download(gpu, r->flags, r->flag, &more, 1);
    if (r->st == OK && more && r->n == r->most)
        r->st =
            fail(E_NUMERIC, "%s after %u rounds: the device computes wrongly", r->what, (unsigned)r->most);
    return r->st != OK || !more;
}

bool gpu_round(struct gpu *gpu, struct gpu_work *work, struct gpu_rounds *r)
{
    if (r->n == 0) {
        assert(work->depth < DEPTH_MAX && r->most > 0 && (!r->bounded || r->most < FLAGS));
        r->flags = work->flags[work->depth++];
        r->outer = gpu->condition;
    }
    if (r->at == r->batch) {
        record_condition(gpu, r->outer);
        if (r->n > 0 && rounds_ended(gpu, r)) {
            work->depth--;
            return false;
        }
        r->batch = !gpu->conditions.begin ? 1 : r->bounded ? r->most : r->batch ? 2 * r->batch : BATCH_FIRST;
        r->batch = r->batch < FLAGS ? r->batch : FLAGS - 1;
        r->batch = r->batch < r->most - r->n ? r->batch : r->most - r->n;
        r->at = 0;
        gpu_fill(gpu, r->flags, 0);
    } else {
        record_condition(gpu, (struct condition){r->flags, r->flag});
    }
    r->flag = ++r->at;
    r->n++;
    return true;
}

status gpu_double_pointers(struct gpu *gpu, struct gpu_work *work, struct gpu_buffer *pointer,
                           struct gpu_buffer *other, size_t n)
{
    struct double_params k = {.n = (uint32_t)n};
    /* A pass doubles the distance; a round has two, so that the result ends in `pointer`. A chain has fewer than n links, and the last round
     * changes nothing. */
    struct gpu_rounds r = {.what = "pointers still double", .most = 1, .bounded = true};
    for (size_t links = n; links > 1; links = (links + 3) / 4)
        r.most++;
    while (gpu_round(gpu, work, &r)) {
        k.flag = r.flag;
        GPU_RUN(gpu, gpu_double, n, k, pointer, other, r.flags);
        GPU_RUN(gpu, gpu_double, n, k, other, pointer, r.flags);
    }
    return r.st;
}
