/* Parallel primitives on buffers: prefix sum, stable counting sort, compaction, reductions over a fixed tree, pointer doubling.
 *
 * All of them only record work, unless they say that they wait. Results do not depend on threads or timing: sums of floats follow one
 * fixed tree, and items with equal keys are ordered by id.
 */
#ifndef HOODOO_PRIMITIVES_H
#define HOODOO_PRIMITIVES_H

#include <stdbool.h>

#include "gpu/gpu.h"

/* Scratch memory for the functions below, for up to n_max values and keys. */
struct gpu_work;
MUST_USE status gpu_work_create(struct gpu *gpu, size_t n_max, struct gpu_work **out);
void gpu_work_destroy(struct gpu *gpu, struct gpu_work **work);

/* Bytes that gpu_work_create() allocates on the device. */
uint64_t gpu_work_bytes(size_t n_max);

/* Exclusive prefix sum, in place: values[i] (uint) becomes the sum of values[0 .. i - 1]; n values. */
void gpu_scan(struct gpu *gpu, struct gpu_work *work, struct gpu_buffer *values, size_t n);

/* Sorts n items by key < n_keys: order[rank] = item. start[key] is the first rank of a key; start has n_keys + 1 items, of which the
 * last is n. Items with equal keys are ordered by id, except for keys >= n_ordered (dead items), whose order is arbitrary. `taken`
 * (n_keys items) and `unordered` (n items) are scratch. */
struct gpu_sort {
    struct gpu_buffer *keys, *ids, *start, *order, *taken, *unordered;
    size_t n, n_keys, n_ordered;
};
void gpu_sort(struct gpu *gpu, struct gpu_work *work, const struct gpu_sort *sort);

/* to[i] = from[order[i]] for n items. */
void gpu_gather(struct gpu *gpu, struct gpu_buffer *order, struct gpu_buffer *from, struct gpu_buffer *to,
                size_t n);

/* list = the numbers i < n for which flags[i] is 1, ascending; *n_list of them. `place` (n items) is scratch. Waits for the count. */
MUST_USE status gpu_compact(struct gpu *gpu, struct gpu_work *work, struct gpu_buffer *flags,
                            struct gpu_buffer *place, struct gpu_buffer *list, size_t n, size_t *n_list);

/* scalars[slot] = the sum, or the largest absolute value, of n floats. gpu_partial_sums() leaves the last step to the caller's kernel:
 * it returns the buffer of REDUCE_THREADS partial sums, which belongs to `work`. */
void gpu_sum(struct gpu *gpu, struct gpu_work *work, struct gpu_buffer *values, size_t n,
             struct gpu_buffer *scalars, uint32_t slot);
void gpu_max(struct gpu *gpu, struct gpu_work *work, struct gpu_buffer *values, size_t n,
             struct gpu_buffer *scalars, uint32_t slot);
struct gpu_buffer *gpu_partial_sums(struct gpu *gpu, struct gpu_work *work, struct gpu_buffer *values,
                                    size_t n);

/* The rounds of a loop that ends with the first round in which no kernel sets the round's flag. They are recorded in batches, and the device
 * itself leaves out the kernels of the rounds after the last, so that the host looks once for each batch; where a device cannot
 * (VK_EXT_conditional_rendering), it looks after each round. Fills and copies are never left out, so they must do no harm after the last round.
 *
 *     struct gpu_rounds r = {.what = "nodes still join", .most = n};
 *     while (gpu_round(gpu, work, &r))
 *         ... a kernel that finds that another round is needed sets item r.flag of r.flags, a buffer of uints, to 1 ...
 *     TRY(r.st);
 *
 * A round may contain another loop, if that is `bounded`. */
struct gpu_rounds {
    const char *what; /* for the message of E_NUMERIC, if the loop does not end */
    uint32_t most;    /* rounds */
    bool bounded;     /* `most` is so small that all rounds are recorded at once, and the host never looks */
    /* set by gpu_round() */
    struct gpu_buffer *flags;
    uint32_t flag;
    status st;
    struct condition {
        struct gpu_buffer *flags;
        uint32_t flag;
    } outer; /* of the round that this loop is in */
    uint32_t n, batch, at;
};
bool gpu_round(struct gpu *gpu, struct gpu_work *work, struct gpu_rounds *r);

/* Pointer doubling: pointer[i] becomes the end of the chain that starts at i. Chains must not have cycles. `other` is scratch of n
 * items. May wait. */
MUST_USE status gpu_double_pointers(struct gpu *gpu, struct gpu_work *work, struct gpu_buffer *pointer,
                                    struct gpu_buffer *other, size_t n);

/* A small buffer of uints, for flags and counters that the host reads. */
struct gpu_buffer *gpu_work_words(struct gpu_work *work);

#endif
