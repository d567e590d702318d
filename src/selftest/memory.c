/* Memory checks: the largest buffer that can be allocated, bound, written and read back, and the amount that many buffers hold at once without
 * overlapping. */
#include <stdio.h>
#include <string.h>

#include "gpu/primitives.h"
#include "selftest/selftest.h"

enum { AT_ONCE = 24 };

/* Shares of the free memory that are tried: less of a CPU's memory, which other programs need, than of a GPU's, which may drive a display. */
static uint64_t share(const struct selftest *t, const struct gpu *gpu)
{
    const uint64_t free = gpu_memory_free(gpu);
    if (!gpu_info(gpu)->is_cpu)
        return free / 10 * 9;
    const uint64_t most = (uint64_t)(t->quick ? 256 : 1536) << 20;
    return free / 4 < most ? free / 4 : most;
}

/* A buffer under test. Its items are vectors if it has more words than kernels can index. */
struct piece {
    struct gpu_buffer *buffer;
    size_t n;
    uint32_t number;
};

static status piece_make(struct gpu *gpu, uint64_t bytes, uint32_t number, struct piece *out)
{
    const size_t item = bytes / 4 > GPU_ITEMS_MAX ? 16 : 4;
    out->n = bytes / item;
    out->number = number;
    return gpu_buffer_create(gpu, "selftest", out->n, item, &out->buffer);
}

/* The tested places: both ends and around the middle. Kernels write there and gather the values back. */
enum { PLACES = 4 };

static void places_of(const struct piece *p, uint32_t at[PLACES])
{
    const uint32_t half = (uint32_t)(p->n / 2);
    memcpy(at, (const uint32_t[PLACES]){0, half, half + 1, (uint32_t)(p->n - 1)}, PLACES * sizeof *at);
}

static uint32_t word_at(const struct piece *p, uint32_t at)
{
    return 0x3f800000u | ((at ^ p->number << 12) & 0x7fffffu);
}

/* A kernel fills a buffer of words entirely with the index of each item; the test values are then written at the places. */
static status piece_write(struct gpu *gpu, struct piece *p, struct row *row)
{
    status st = OK;
    uint32_t at[PLACES], words[PLACES];
    places_of(p, at);
    if (gpu_buffer_item(p->buffer) == 4) {
        const struct count_params k = {(uint32_t)p->n};
        GPU_RUN(gpu, gpu_iota, p->n, k, p->buffer);
        for (size_t i = 0; i < PLACES; i++) {
            TRY(gpu_download(gpu, p->buffer, at[i], &words[i], 1));
            if (words[i] != at[i])
                row_wrong(row, "a kernel wrote item %u of a buffer of %.1f MB, and it is %u", at[i],
                          (double)p->n * 4 / 1e6, words[i]);
        }
    }
    for (size_t i = 0; i < PLACES; i++) {
        const uint32_t word = word_at(p, at[i]), vector[4] = {word, word, word, word};
        TRY(gpu_upload(gpu, p->buffer, at[i], vector, 1));
    }
done:
    return st;
}

/* With a kernel that binds the buffer. */
static status piece_read(struct gpu *gpu, const struct piece *p, struct row *row)
{
    status st = OK;
    const size_t item = gpu_buffer_item(p->buffer);
    struct gpu_buffer *order = NULL, *to = NULL;
    uint32_t at[PLACES], got[4 * PLACES];
    places_of(p, at);
    TRY(gpu_buffer_create(gpu, "selftest", PLACES, 4, &order));
    TRY(gpu_buffer_create(gpu, "selftest", PLACES, item, &to));
    TRY(gpu_upload(gpu, order, 0, at, PLACES));
    gpu_gather(gpu, order, p->buffer, to, PLACES);
    TRY(gpu_download(gpu, to, 0, got, PLACES));
    for (size_t i = 0; i < PLACES; i++)
        if (got[i * item / 4] != word_at(p, at[i]))
            row_wrong(row, "item %u of a buffer of %.1f MB, number %u, is 0x%08x and was written 0x%08x",
                      at[i], (double)p->n * (double)item / 1e6, p->number, got[i * item / 4],
                      word_at(p, at[i]));
done:
    gpu_buffer_destroy(gpu, &order);
    gpu_buffer_destroy(gpu, &to);
    return st;
}

/* Allocates and tests a buffer of this size; *had: there was memory for it. It is an error if memory that is reported free cannot be had. */
static status one_buffer(struct gpu *gpu, uint64_t bytes, struct row *row, bool *had)
{
    status st = OK;
    struct piece p = {0};
    st = piece_make(gpu, bytes, 1, &p);
    *had = st == OK;
    if (st == E_MEMORY) {
        if (bytes <= gpu_limits(gpu).allocation && bytes <= gpu_memory_free(gpu) / 2)
            row_wrong(row, "%s", status_message());
        return OK;
    }
    TRY(st);
    TRY(piece_write(gpu, &p, row));
    TRY(piece_read(gpu, &p, row));
done:
    gpu_buffer_destroy(gpu, &p.buffer);
    return st;
}

static status largest(struct selftest *t, const void *what, struct row *row)
{
    (void)what;
    status st = OK;
    struct gpu *gpu = NULL;
    uint64_t most = 0, refused = 0;
    bool had;
    TRY(gpu_create(&(struct gpu_options){.device = t->device}, &gpu));
    const struct gpu_limits limits = gpu_limits(gpu);
    const uint64_t cap = share(t, gpu) < GPU_ITEMS_MAX * 16 ? share(t, gpu) : GPU_ITEMS_MAX * 16;
    const uint64_t limit[] = {limits.range / 2, limits.range, limits.range + 4096, limits.allocation, cap};
    for (uint64_t bytes = 1 << 20; bytes <= cap && !refused; bytes *= 2) {
        TRY(selftest_stop(t));
        TRY(one_buffer(gpu, bytes, row, &had));
        most = had ? bytes : most;
        refused = had ? 0 : bytes;
    }
    for (size_t i = 0; i < sizeof limit / sizeof *limit; i++)
        if (limit[i] <= cap) {
            TRY(one_buffer(gpu, limit[i] / 16 * 16, row, &had));
            most = had && limit[i] > most ? limit[i] / 16 * 16 : most;
        }
    row_found(row, "%.1f MB, bound, written and read back", (double)most / 1e6);
    row_value(row, "bytes", (double)most);
    row_value(row, "tried_up_to_bytes", (double)cap);
    row_value(row, "refused_bytes", (double)refused);
done:
    gpu_destroy(&gpu);
    return st;
}

static status at_once(struct selftest *t, const void *what, struct row *row)
{
    (void)what;
    status st = OK;
    struct gpu *gpu = NULL;
    struct piece piece[AT_ONCE] = {{0}};
    size_t n = 0;
    TRY(gpu_create(&(struct gpu_options){.device = t->device}, &gpu));
    const uint64_t bytes = share(t, gpu) / AT_ONCE / 16 * 16;
    for (; n < AT_ONCE; n++) {
        TRY(selftest_stop(t));
        st = piece_make(gpu, bytes, (uint32_t)n + 1, &piece[n]);
        if (st == E_MEMORY) {
            row_wrong(row, "after %zu buffers of %.1f MB: %s", n, (double)bytes / 1e6, status_message());
            st = OK;
            break;
        }
        TRY(st);
        TRY(piece_write(gpu, &piece[n], row));
    }
    for (size_t i = 0; i < n; i++)
        TRY(piece_read(gpu, &piece[i], row));
    row_found(row, "%zu buffers, %.1f MB at once", n, (double)n * (double)bytes / 1e6);
    row_value(row, "buffers", (double)n);
    row_value(row, "bytes", (double)n * (double)bytes);
done:
    for (size_t i = 0; i < AT_ONCE; i++)
        if (gpu)
            gpu_buffer_destroy(gpu, &piece[i].buffer);
    gpu_destroy(&gpu);
    return st;
}

status selftest_memory(struct selftest *t)
{
    status st = OK;
    TRY(selftest_do(t, "memory", "largest buffer", largest, NULL));
    TRY(selftest_do(t, "memory", "many buffers", at_once, NULL));
done:
    return st;
}
