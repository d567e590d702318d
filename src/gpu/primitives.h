/* Building blocks over buffers: scan, stable counting sort, compaction, fixed-tree reductions, pointer
 * doubling.
 *
 * All record only, unless they say that they wait. Results do not depend on threads or timing: sums of floats
 * follow one fixed tree, and items of one key are ordered by id.
 */
#ifndef HOODOO_PRIMITIVES_H
#define HOODOO_PRIMITIVES_H

#include "gpu/gpu.h"

/* Scratch for the functions below, for up to n_max values and keys. */
struct gpu_work;
MUST_USE status gpu_work_create(struct gpu *gpu, size_t n_max, struct gpu_work **out);
void gpu_work_destroy(struct gpu *gpu, struct gpu_work **work);

/* Bytes gpu_work_create() takes on the device. */
uint64_t gpu_work_bytes(size_t n_max);

/* values[i] (uint) becomes the sum of all before it; n values. */
void gpu_scan(struct gpu *gpu, struct gpu_work *work, struct gpu_buffer *values, size_t n);

/* Sorts n items by key < n_keys: order[rank] = item. start[key] is the first rank of a key; it has n_keys + 1
 * items, the last the total. Items of one key are ordered by id, but for keys from n_ordered on (the dead),
 * which come in any order. `start` is overwritten; `taken` is scratch of n_keys items, `unordered` of n. */
struct gpu_sort {
    struct gpu_buffer *keys, *ids, *start, *order, *taken, *unordered;
    size_t n, n_keys, n_ordered;
};
void gpu_sort(struct gpu *gpu, struct gpu_work *work, const struct gpu_sort *sort);

/* to[i] = from[order[i]] for n items. */
void gpu_gather(struct gpu *gpu, struct gpu_buffer *order, struct gpu_buffer *from, struct gpu_buffer *to,
                size_t n);

/* list = the numbers i < n with flags[i] = 1, ascending. `place` (n items) is scratch. Waits, to know how many. */
MUST_USE status gpu_compact(struct gpu *gpu, struct gpu_work *work, struct gpu_buffer *flags,
                            struct gpu_buffer *place, struct gpu_buffer *list, size_t n, size_t *n_list);

/* scalars[slot] = the sum (or largest absolute value) of n floats. gpu_partial_sums() is for kernels that do
 * the last step themselves: REDUCE_THREADS partial sums in the work's buffer. */
void gpu_sum(struct gpu *gpu, struct gpu_work *work, struct gpu_buffer *values, size_t n,
             struct gpu_buffer *scalars, uint32_t slot);
void gpu_max(struct gpu *gpu, struct gpu_work *work, struct gpu_buffer *values, size_t n,
             struct gpu_buffer *scalars, uint32_t slot);
struct gpu_buffer *gpu_partial_sums(struct gpu *gpu, struct gpu_work *work, struct gpu_buffer *values,
                                    size_t n);

/* Doubles n pointers until they stand still: pointer[i] becomes the end of i's chain, which must not be a
 * cycle. `other` is scratch of n items. Waits. */
MUST_USE status gpu_double_pointers(struct gpu *gpu, struct gpu_work *work, struct gpu_buffer *pointer,
                                    struct gpu_buffer *other, size_t n);

/* A small buffer of words for flags and counters that the host reads. */
struct gpu_buffer *gpu_work_words(struct gpu_work *work);

#endif
