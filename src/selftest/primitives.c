/* Kernel checks: scan, sort, compaction, gathers, reductions and pointer doubling against plain C, at sizes around those of workgroups and
 * runs, in every variant of the kernels. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "base/random.h"
#include "gpu/kernel_source.h"
#include "gpu/primitives.h"
#include "selftest/selftest.h"

static const size_t sizes[] = {1, 2, 63, 64, 65, 4095, 4097, 131071, 300001};
enum { SIZES = sizeof sizes / sizeof *sizes, KEYS = 7001, BUFFERS = 8 };

/* The data for one size on one device; one_primitive() frees it. */
struct bench {
    struct gpu *gpu;
    struct gpu_work *work;
    struct gpu_buffer *buffer[BUFFERS];
    size_t n_buffers, n;
    uint32_t *data, *expected, *got; /* [4 n + KEYS + 1] each */
    struct row *row;
};

static status put(struct bench *b, struct gpu_buffer **out, const uint32_t *words, size_t n, size_t item)
{
    status st = gpu_buffer_create(b->gpu, "selftest", n, item, out);
    if (st == OK)
        b->buffer[b->n_buffers++] = *out;
    return st == OK && words ? gpu_upload(b->gpu, *out, 0, words, n) : st;
}
#define PUT(name, ...)                                                                                       \
    struct gpu_buffer *name = NULL;                                                                          \
    TRY(put(b, &name, __VA_ARGS__))

static uint32_t noise(size_t i, uint32_t what)
{
    return random_hash((uint32_t)i, what, 0, 0);
}

static status compare(struct bench *b, struct gpu_buffer *from, size_t n, const char *what)
{
    char why[WHY_BYTES];
    status st = gpu_download(b->gpu, from, 0, b->got, n);
    if (st == OK && !same_words(b->expected, b->got, n * gpu_buffer_item(from) / 4, why))
        row_wrong(b->row, "%s of %zu with kernels of variant %s: %s", what, b->n, gpu_limits(b->gpu).variant,
                  why);
    return st;
}

static void draw(struct bench *b, uint32_t below)
{
    for (size_t i = 0; i < b->n; i++)
        b->data[i] = (uint32_t)((uint64_t)below * noise(i, 7) >> 32);
}

static status scan(struct bench *b)
{
    status st = OK;
    draw(b, 1000);
    PUT(values, b->data, b->n, 4);
    for (size_t i = 0, sum = 0; i < b->n; sum += b->data[i++])
        b->expected[i] = (uint32_t)sum;
    gpu_scan(b->gpu, b->work, values, b->n);
    TRY(compare(b, values, b->n, "the scan"));
done:
    return st;
}

struct item {
    uint32_t key, id, at;
};

static int by_key_and_id(const void *a, const void *b)
{
    const struct item *x = a, *y = b;
    return x->key != y->key ? (x->key > y->key) - (x->key < y->key) : (x->id > y->id) - (x->id < y->id);
}

static status sort(struct bench *b)
{
    status st = OK;
    struct item *item = NULL;
    draw(b, KEYS);
    TRY(memory_alloc(b->n, sizeof *item, "the sort", &item));
    for (uint32_t i = 0; i < b->n; i++)
        item[i] = (struct item){b->data[i], i * 2654435761u, i}; /* ids: unique and unordered */
    for (size_t i = 0; i < b->n; i++)
        b->got[i] = item[i].id;
    PUT(keys, b->data, b->n, 4);
    PUT(ids, b->got, b->n, 4);
    PUT(start, NULL, KEYS + 1, 4);
    PUT(order, NULL, b->n, 4);
    PUT(taken, NULL, KEYS, 4);
    PUT(unordered, NULL, b->n, 4);
    const struct gpu_sort s = {keys, ids, start, order, taken, unordered, b->n, KEYS, KEYS};
    gpu_sort(b->gpu, b->work, &s);
    qsort(item, b->n, sizeof *item, by_key_and_id);
    for (size_t i = 0; i < b->n; i++)
        b->expected[i] = item[i].at;
    TRY(compare(b, order, b->n, "the order of a sort"));
    memset(b->expected, 0, (KEYS + 1) * sizeof *b->expected);
    for (size_t i = 0; i < b->n; i++)
        b->expected[item[i].key + 1]++;
    for (size_t k = 0; k < KEYS; k++)
        b->expected[k + 1] += b->expected[k];
    TRY(compare(b, start, KEYS + 1, "the starts of a sort"));
done:
    free(item);
    return st;
}

static status compact(struct bench *b)
{
    status st = OK;
    size_t n_list = 0, n = 0;
    draw(b, 2);
    PUT(flags, b->data, b->n, 4);
    PUT(place, NULL, b->n, 4);
    PUT(list, NULL, b->n, 4);
    for (uint32_t i = 0; i < b->n; i++)
        if (b->data[i])
            b->expected[n++] = i;
    TRY(gpu_compact(b->gpu, b->work, flags, place, list, b->n, &n_list));
    if (n_list != n)
        row_wrong(b->row, "%zu of %zu flags are set, and %zu were found", n, b->n, n_list);
    TRY(compare(b, list, n, "the compaction"));
done:
    return st;
}

/* Bits of floats from 1 to 2, so that words and floats hold the same values. */
static uint32_t word(size_t i)
{
    return 0x3f800000u | noise(i, 11) >> 9;
}

static status gather(struct bench *b)
{
    status st = OK;
    draw(b, (uint32_t)b->n);
    PUT(order, b->data, b->n, 4);
    for (size_t i = 0; i < 4 * b->n; i++)
        b->got[i] = word(i);
    PUT(words, b->got, b->n, 4);
    PUT(vectors, b->got, b->n, 16);
    PUT(to_words, NULL, b->n, 4);
    PUT(to_vectors, NULL, b->n, 16);
    gpu_gather(b->gpu, order, words, to_words, b->n);
    gpu_gather(b->gpu, order, vectors, to_vectors, b->n);
    for (size_t i = 0; i < b->n; i++)
        memcpy(&b->expected[4 * i], &b->got[4 * (size_t)b->data[i]], 16);
    /* The words come second, from the data of the vectors, since `got` is overwritten. */
    TRY(compare(b, to_vectors, b->n, "the gather of vectors"));
    for (size_t i = 0; i < b->n; i++)
        b->expected[i] = word(b->data[i]);
    TRY(compare(b, to_words, b->n, "the gather of words"));
done:
    return st;
}

static status reduce(struct bench *b)
{
    status st = OK;
    char why[WHY_BYTES];
    float got[2];
    double sum = 0, most = 0;
    for (size_t i = 0; i < b->n; i++) {
        const float value = (float)noise(i, 3) / 4294967296.0f - 0.25f;
        memcpy(&b->data[i], &value, 4);
        sum += (double)value;
        most = fmax(most, fabs((double)value));
    }
    PUT(values, b->data, b->n, 4);
    PUT(scalars, NULL, 8, 4);
    gpu_sum(b->gpu, b->work, values, b->n, scalars, 3);
    gpu_max(b->gpu, b->work, values, b->n, scalars, 4);
    TRY(gpu_download(b->gpu, scalars, 3, got, 2));
    /* Floats are summed in a tree, with at most a few hundred additions in sequence. */
    if (!near_number("the sum", sum, (double)got[0], 1e-4, why) ||
        !near_number("the greatest", most, (double)got[1], 0, why))
        row_wrong(b->row, "of %zu numbers with kernels of variant %s: %s", b->n, gpu_limits(b->gpu).variant,
                  why);
done:
    return st;
}

static status doubling(struct bench *b)
{
    status st = OK;
    /* A long chain and a random tree. */
    for (uint32_t i = 0; i < b->n; i++)
        b->data[i] = i < 3 ? i : i < b->n / 2 ? i - 1 : noise(i, 5) % i;
    PUT(pointer, b->data, b->n, 4);
    PUT(other, NULL, b->n, 4);
    for (size_t i = 0; i < b->n; i++)
        b->expected[i] = b->data[i] == i ? (uint32_t)i : b->expected[b->data[i]];
    TRY(gpu_double_pointers(b->gpu, b->work, pointer, other, b->n));
    TRY(compare(b, pointer, b->n, "the ends of chains"));
done:
    return st;
}

static status one_size(struct bench *b, status (*primitive)(struct bench *))
{
    status st = OK;
    const size_t room = 4 * b->n + KEYS + 1;
    TRY(memory_alloc(room, 4, "the selftest", &b->data));
    TRY(memory_alloc(room, 4, "the selftest", &b->expected));
    TRY(memory_alloc(room, 4, "the selftest", &b->got));
    TRY(gpu_work_create(b->gpu, b->n > KEYS ? b->n : KEYS, &b->work));
    TRY(primitive(b));
done:
    for (size_t i = 0; i < b->n_buffers; i++)
        gpu_buffer_destroy(b->gpu, &b->buffer[i]);
    gpu_work_destroy(b->gpu, &b->work);
    free(b->data);
    free(b->expected);
    free(b->got);
    return st;
}

static const struct primitive {
    const char *name;
    status (*check)(struct bench *b);
} primitives[] = {{"scan", scan},     {"sort", sort},     {"compaction", compact},
                  {"gather", gather}, {"reduce", reduce}, {"pointer doubling", doubling}};

static status one_primitive(struct selftest *t, const void *what, struct row *row)
{
    status st = OK;
    const struct primitive *p = what;
    struct gpu *gpu = NULL;
    for (int variant = 0; variant < VARIANTS; variant++) {
        TRY(selftest_stop(t));
        TRY(gpu_create(&(struct gpu_options){.device = t->device, .variant = variant + 1}, &gpu));
        for (size_t i = 0; i < SIZES && row->ok; i++)
            TRY(one_size(&(struct bench){.gpu = gpu, .n = sizes[i], .row = row}, p->check));
        gpu_destroy(&gpu);
    }
    row_found(row, "%d sizes to %zu, %d variants", SIZES, sizes[SIZES - 1], VARIANTS);
done:
    gpu_destroy(&gpu);
    return st;
}

status selftest_primitives(struct selftest *t)
{
    status st = OK;
    for (size_t i = 0; i < sizeof primitives / sizeof *primitives; i++)
        TRY(selftest_do(t, "kernels against plain C", primitives[i].name, one_primitive, &primitives[i]));
done:
    return st;
}
