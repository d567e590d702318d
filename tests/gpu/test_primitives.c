/* Scan, sort, compaction, reductions and pointer doubling against plain C, in every kernel variant and past
 * the device's range. */
#include "check.h"

#include <stdlib.h>
#include <string.h>

#include "gpu/kernel_source.h"
#include "gpu/primitives.h"

static uint32_t noise(uint32_t x)
{
    x = (x ^ 61u) ^ (x >> 16);
    x *= 9u;
    x ^= x >> 4;
    x *= 0x27d4eb2du;
    return x ^ (x >> 15);
}

static struct gpu *open_gpu(void **state)
{
    const struct gpu_options *options = *state;
    struct gpu *gpu = NULL;
    assert_ok(gpu_create(options, &gpu));
    return gpu;
}

static struct gpu_buffer *buffer_of(struct gpu *gpu, const void *data, size_t n)
{
    struct gpu_buffer *b = NULL;
    assert_ok(gpu_buffer_create(gpu, "test", n, 4, &b));
    if (data)
        assert_ok(gpu_upload(gpu, b, 0, data, n));
    return b;
}

static uint32_t *random_words(size_t n, uint32_t below)
{
    uint32_t *v = malloc((n + 1) * sizeof *v);
    for (size_t i = 0; i < n; i++)
        v[i] = noise((uint32_t)i) % below;
    return v;
}

static void scan_equals_running_sum(void **state)
{
    static const size_t sizes[] = {1, 2, 63, 64, 65, 4096, 4097, 300001};
    struct gpu *gpu = open_gpu(state);
    struct gpu_work *work;
    assert_ok(gpu_work_create(gpu, 300001, &work));
    for (size_t s = 0; s < sizeof sizes / sizeof *sizes; s++) {
        size_t n = sizes[s];
        uint32_t *v = random_words(n, 1000), *got = malloc(n * 4), sum = 0;
        struct gpu_buffer *b = buffer_of(gpu, v, n);
        gpu_scan(gpu, work, b, n);
        assert_ok(gpu_download(gpu, b, 0, got, n));
        for (size_t i = 0; i < n; sum += v[i++])
            assert_int_equal(got[i], sum);
        gpu_buffer_destroy(gpu, &b);
        free(v);
        free(got);
    }
    gpu_work_destroy(gpu, &work);
    gpu_destroy(&gpu);
}

static void sort_is_stable_by_id(void **state)
{
    enum { N = 50000, KEYS = 7000 };
    struct gpu *gpu = open_gpu(state);
    struct gpu_work *work;
    uint32_t *keys = random_words(N, KEYS), *ids = malloc(N * 4), *order = malloc(N * 4),
             *start = malloc((KEYS + 1) * 4);
    assert_ok(gpu_work_create(gpu, N, &work));
    for (uint32_t i = 0; i < N; i++)
        ids[i] = i * 2654435761u; /* unique, in no order */
    struct gpu_sort sort = {.keys = buffer_of(gpu, keys, N),
                            .ids = buffer_of(gpu, ids, N),
                            .start = buffer_of(gpu, NULL, KEYS + 1),
                            .order = buffer_of(gpu, NULL, N),
                            .taken = buffer_of(gpu, NULL, KEYS),
                            .unordered = buffer_of(gpu, NULL, N),
                            .n = N,
                            .n_keys = KEYS,
                            .n_ordered = KEYS};
    gpu_sort(gpu, work, &sort);
    assert_ok(gpu_download(gpu, sort.order, 0, order, N));
    assert_ok(gpu_download(gpu, sort.start, 0, start, KEYS + 1));
    assert_int_equal(start[KEYS], N);
    for (uint32_t r = 0; r < N; r++) {
        uint32_t i = order[r];
        assert_true(start[keys[i]] <= r && r < start[keys[i] + 1]);
        if (r > 0)
            assert_true(keys[order[r - 1]] < keys[i] ||
                        (keys[order[r - 1]] == keys[i] && ids[order[r - 1]] < ids[i]));
    }
    gpu_buffer_destroy(gpu, &sort.keys);
    gpu_buffer_destroy(gpu, &sort.ids);
    gpu_buffer_destroy(gpu, &sort.start);
    gpu_buffer_destroy(gpu, &sort.order);
    gpu_buffer_destroy(gpu, &sort.taken);
    gpu_buffer_destroy(gpu, &sort.unordered);
    gpu_work_destroy(gpu, &work);
    gpu_destroy(&gpu);
    free(keys);
    free(ids);
    free(order);
    free(start);
}

static void compaction_keeps_order(void **state)
{
    enum { N = 12345 };
    struct gpu *gpu = open_gpu(state);
    struct gpu_work *work;
    uint32_t *flags = random_words(N, 2), *list = malloc(N * 4);
    size_t n_list, expected = 0;
    assert_ok(gpu_work_create(gpu, N, &work));
    struct gpu_buffer *f = buffer_of(gpu, flags, N), *place = buffer_of(gpu, NULL, N),
                      *l = buffer_of(gpu, NULL, N);
    assert_ok(gpu_compact(gpu, work, f, place, l, N, &n_list));
    assert_ok(gpu_download(gpu, l, 0, list, n_list));
    for (uint32_t i = 0; i < N; i++)
        if (flags[i])
            assert_int_equal(list[expected++], i);
    assert_int_equal(n_list, expected);
    gpu_buffer_destroy(gpu, &f);
    gpu_buffer_destroy(gpu, &place);
    gpu_buffer_destroy(gpu, &l);
    gpu_work_destroy(gpu, &work);
    gpu_destroy(&gpu);
    free(flags);
    free(list);
}

static void reductions_agree_with_double(void **state)
{
    enum { N = 100003 };
    struct gpu *gpu = open_gpu(state);
    struct gpu_work *work;
    float *v = malloc(N * sizeof *v), got[2], most = 0;
    double sum = 0;
    assert_ok(gpu_work_create(gpu, N, &work));
    for (uint32_t i = 0; i < N; i++) {
        v[i] = (float)noise(i) / 4294967296.0f - 0.25f;
        sum += (double)v[i];
        most = v[i] > most ? v[i] : -v[i] > most ? -v[i] : most;
    }
    struct gpu_buffer *b = buffer_of(gpu, v, N), *scalars = buffer_of(gpu, NULL, 8);
    gpu_sum(gpu, work, b, N, scalars, 3);
    gpu_max(gpu, work, b, N, scalars, 4);
    assert_ok(gpu_download(gpu, scalars, 3, got, 2));
    assert_true((double)got[0] > sum * (1 - 1e-5) && (double)got[0] < sum * (1 + 1e-5));
    assert_true(got[1] >= most && got[1] <= most);
    v[N / 2] = (float)0x7fc00000; /* replaced below by a NaN, by its bits */
    uint32_t nan = 0x7fc00000u;
    memcpy(&v[N / 2], &nan, 4);
    assert_ok(gpu_upload(gpu, b, 0, v, N));
    gpu_max(gpu, work, b, N, scalars, 4);
    assert_ok(gpu_download(gpu, scalars, 4, got, 1));
    assert_true(got[0] > 1e38f);
    gpu_buffer_destroy(gpu, &b);
    gpu_buffer_destroy(gpu, &scalars);
    gpu_work_destroy(gpu, &work);
    gpu_destroy(&gpu);
    free(v);
}

static void pointers_double_to_their_roots(void **state)
{
    enum { N = 40000 };
    struct gpu *gpu = open_gpu(state);
    struct gpu_work *work;
    uint32_t *p = malloc(N * 4), *got = malloc(N * 4);
    assert_ok(gpu_work_create(gpu, N, &work));
    for (uint32_t i = 0; i < N; i++)
        p[i] = i < 10 ? i : i < N / 2 ? i - 1 : noise(i) % i; /* one long chain, and a bush */
    struct gpu_buffer *b = buffer_of(gpu, p, N), *other = buffer_of(gpu, NULL, N);
    assert_ok(gpu_double_pointers(gpu, work, b, other, N));
    assert_ok(gpu_download(gpu, b, 0, got, N));
    for (uint32_t i = 0; i < N; i++) {
        uint32_t root = i;
        while (p[root] != root)
            root = p[root] < i ? got[p[root]] : p[root];
        assert_int_equal(got[i], root);
    }
    gpu_buffer_destroy(gpu, &b);
    gpu_buffer_destroy(gpu, &other);
    gpu_work_destroy(gpu, &work);
    gpu_destroy(&gpu);
    free(p);
    free(got);
}

/* The rounds after the last one may be recorded, but their kernels do not run: a count is raised in each. A chain of 4^6 links, which takes six
 * rounds and one that changes nothing, and a loop that is over at once. */
static void rounds_after_the_last_are_left_out(void **state)
{
    enum { N = 5000, LINKS = 4096 };
    struct gpu *gpu = open_gpu(state);
    struct gpu_work *work;
    uint32_t *chain = malloc(N * 4), got[N];
    assert_ok(gpu_work_create(gpu, N, &work));
    struct gpu_buffer *other = buffer_of(gpu, NULL, N);
    for (uint32_t links = 0; links <= LINKS; links += LINKS) {
        const uint32_t count[2] = {0, 1};
        for (uint32_t i = 0; i < N; i++)
            chain[i] = i > 0 && i <= links ? i - 1 : i;
        struct gpu_buffer *pointer = buffer_of(gpu, chain, N), *counter = buffer_of(gpu, count, 2);
        const struct scan_params add = {1, 2};
        struct gpu_rounds r = {.what = "links", .most = 100};
        while (gpu_round(gpu, work, &r)) {
            const struct double_params k = {N, r.flag};
            GPU_RUN(gpu, gpu_double, N, k, pointer, other, r.flags);
            GPU_RUN(gpu, gpu_double, N, k, other, pointer, r.flags);
            GPU_RUN(gpu, gpu_scan_sum, 1, add, counter, counter);
        }
        assert_ok(r.st);
        assert_ok(gpu_download(gpu, pointer, 0, got, N));
        for (uint32_t i = 0; i < N; i++)
            assert_int_equal(got[i], i <= links ? 0 : i);
        assert_ok(gpu_download(gpu, counter, 0, got, 1));
        assert_int_equal(got[0], links ? 7 : 1);
        gpu_buffer_destroy(gpu, &pointer);
        gpu_buffer_destroy(gpu, &counter);
    }
    gpu_buffer_destroy(gpu, &other);
    gpu_work_destroy(gpu, &work);
    gpu_destroy(&gpu);
    free(chain);
}

/* lavapipe binds at most 128 MiB as a storage buffer. */
static void buffers_beyond_the_storage_range_work(void **state)
{
    enum { N = 48 << 20 };
    struct gpu *gpu = open_gpu(state);
    struct gpu_buffer *b = buffer_of(gpu, NULL, N);
    struct count_params k = {N};
    uint32_t got[3];
    GPU_RUN(gpu, gpu_iota, N, k, b);
    assert_ok(gpu_download(gpu, b, N - 3, got, 3));
    assert_int_equal(got[0], N - 3);
    assert_int_equal(got[2], N - 1);
    assert_ok(gpu_download(gpu, b, 33554433, got, 1));
    assert_int_equal(got[0], 33554433);
    gpu_buffer_destroy(gpu, &b);
    gpu_destroy(&gpu);
}

/* More pairs of buffers than the device keeps descriptor sets for, among them new buffers in the place of destroyed ones. */
static void every_dispatch_finds_its_own_buffers(void **state)
{
    enum { N = 64, BUFFERS = 50, ROUNDS = 55 };
    struct gpu *gpu = open_gpu(state);
    struct gpu_buffer *from[BUFFERS], *to[BUFFERS], *order = buffer_of(gpu, NULL, N);
    const struct count_params k = {N};
    uint32_t got;
    GPU_RUN(gpu, gpu_iota, N, k, order);
    for (uint32_t i = 0; i < BUFFERS; i++) {
        from[i] = buffer_of(gpu, NULL, N);
        to[i] = buffer_of(gpu, NULL, N);
        gpu_fill(gpu, from[i], i);
    }
    for (uint32_t r = 0; r < ROUNDS; r++) {
        for (uint32_t i = 0; i < BUFFERS; i++)
            gpu_gather(gpu, order, from[(i + r) % BUFFERS], to[i], N);
        assert_ok(gpu_download(gpu, to[r % BUFFERS], N - 1, &got, 1));
        assert_int_equal(got, 2 * r % BUFFERS);
        struct gpu_buffer **renewed = &from[r % BUFFERS];
        gpu_buffer_destroy(gpu, renewed);
        *renewed = buffer_of(gpu, NULL, N);
        gpu_fill(gpu, *renewed, r % BUFFERS);
    }
    for (int i = 0; i < BUFFERS; i++) {
        gpu_buffer_destroy(gpu, &from[i]);
        gpu_buffer_destroy(gpu, &to[i]);
    }
    gpu_buffer_destroy(gpu, &order);
    gpu_destroy(&gpu);
}

/* Transfers of every size, from a word to several pieces of the staging buffer, at odd places, behind kernels that are not awaited. */
static void transfers_are_exact(void **state)
{
    enum { N = 10 << 20 };
    static const struct {
        size_t first, n;
    } part[] = {{3, 1}, {5, 1023}, {5, 1025}, {7, (4 << 20) + 1}, {0, N}, {11, N - 13}, {N, 0}};
    struct gpu *gpu = open_gpu(state);
    struct gpu_buffer *b = buffer_of(gpu, NULL, N);
    const struct count_params k = {N};
    uint32_t *data = random_words(N, UINT32_MAX), *got = malloc(N * 4), *expected = malloc(N * 4);
    for (size_t p = 0; p < sizeof part / sizeof *part; p++) {
        GPU_RUN(gpu, gpu_iota, N, k, b);
        assert_ok(gpu_upload(gpu, b, part[p].first, data, part[p].n));
        for (uint32_t i = 0; i < N; i++)
            expected[i] = i;
        memcpy(expected + part[p].first, data, part[p].n * 4);
        assert_ok(gpu_download(gpu, b, 0, got, N));
        assert_memory_equal(got, expected, N * 4);
        memset(got, 0xff, N * 4);
        assert_ok(gpu_download(gpu, b, part[p].first, got, part[p].n));
        assert_memory_equal(got, data, part[p].n * 4);
        if (part[p].n < N)
            assert_int_equal(got[part[p].n], UINT32_MAX);
    }
    free(data);
    free(got);
    free(expected);
    gpu_buffer_destroy(gpu, &b);
    gpu_destroy(&gpu);
}

static void unknown_devices_are_refused(void **state)
{
    static const char *const wrong[] = {"99", "uuid:00000000000000000000000000000001", "pci:ffff:ff:1f.7",
                                        "slurm"};
    struct gpu *gpu = NULL;
    (void)state;
    unsetenv("SLURM_JOB_GPUS");
    unsetenv("SLURM_STEP_GPUS");
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
        if (i == 3 && gpu_create(&(struct gpu_options){.device = "auto"}, &gpu) == OK &&
            !gpu_info(gpu)->is_cpu) {
            gpu_destroy(&gpu); /* with one GPU Slurm needs no number */
            continue;
        }
        gpu_destroy(&gpu);
        assert_int_equal(gpu_create(&(struct gpu_options){.device = wrong[i]}, &gpu), E_DEVICE);
        assert_non_null(strstr(status_message(), "devices here"));
    }
    assert_int_equal(gpu_create(&(struct gpu_options){.device = "first"}, &gpu), E_USAGE);
}

static void a_buffer_too_large_is_refused_with_its_size(void **state)
{
    struct gpu *gpu = open_gpu(state);
    struct gpu_buffer *b = NULL;
    assert_int_equal(gpu_buffer_create(gpu, "huge", (size_t)1 << 40, 16, &b), E_MEMORY);
    assert_non_null(strstr(status_message(), "huge"));
    assert_non_null(strstr(status_message(), "MB"));
    assert_ok(gpu_buffer_create(gpu, "small", 16, 16, &b));
    gpu_buffer_destroy(gpu, &b);
    gpu_destroy(&gpu);
}

/* What a device cannot allocate is named with the limit that it met, and less can be had after. */
static void limits_of_allocations_are_named(void **state)
{
    (void)state;
    enum { MOST = 40 };
    struct gpu *gpu = NULL;
    struct gpu_buffer *buffer[MOST] = {NULL}, *more = NULL;
    size_t n = 0;
    const struct gpu_options options = {
        .device = "auto", .allocation_limit = 64 << 20, .allocations_limit = 12};
    assert_ok(gpu_create(&options, &gpu));
    assert_int_equal(gpu_buffer_create(gpu, "wide", 17 << 20, 4, &more), E_MEMORY);
    assert_null(more);
    assert_non_null(strstr(status_message(), "the wide buffer needs 71.3 MB"));
    assert_non_null(strstr(status_message(), "at most 67.1 MB per allocation"));
    /* The last count that 32 bits hold is one of memory, and those after it are told apart from what they would wrap to. */
    assert_int_equal(gpu_buffer_create(gpu, "largest", GPU_ITEMS_MAX, 4, &more), E_MEMORY);
    assert_null(strstr(status_message(), "kernels can address"));
    static const size_t beyond[] = {GPU_ITEMS_MAX + 1, (size_t)UINT32_MAX + 17, (size_t)1 << 40,
                                    SIZE_MAX / 16};
    for (size_t i = 0; i < sizeof beyond / sizeof *beyond; i++) {
        assert_int_equal(gpu_buffer_create(gpu, "endless", beyond[i], 4, &more), E_MEMORY);
        assert_null(more);
        assert_non_null(strstr(status_message(), "the endless buffer needs "));
        assert_non_null(strstr(status_message(), "kernels can address at most 4294966272 items"));
    }
    while (n < MOST && gpu_buffer_create(gpu, "small", 16, 4, &buffer[n]) == OK)
        n++;
    assert_in_range(n, 1, 12);
    assert_non_null(
        strstr(status_message(), "cannot allocate the small buffer: the device allows 12 allocations"));
    assert_ok(gpu_wait(gpu));
    gpu_buffer_destroy(gpu, &buffer[n - 1]);
    assert_ok(gpu_buffer_create(gpu, "small", 16, 4, &buffer[n - 1]));
    for (size_t i = 0; i < n; i++)
        gpu_buffer_destroy(gpu, &buffer[i]);
    gpu_destroy(&gpu);
}

int main(void)
{
    static struct gpu_options own = {.device = "auto"};
    static struct gpu_options storage = {.device = "auto", .variant = VARIANT_STORAGE + 1};
    static struct gpu_options unconditional = {.device = "auto", .unconditional = true};
    static struct gpu_options staged = {.device = "auto", .staged = true};
    static struct gpu_options wide = {.device = "auto", .range_limit = 1};
#define EACH(test, options)                                                                                  \
    {                                                                                                        \
#test " (" #options ")", test, NULL, NULL, &options                                                  \
    }
    const struct CMUnitTest tests[] = {
        EACH(scan_equals_running_sum, own),
        EACH(scan_equals_running_sum, storage),
        EACH(scan_equals_running_sum, wide),
        EACH(sort_is_stable_by_id, own),
        EACH(sort_is_stable_by_id, storage),
        EACH(sort_is_stable_by_id, wide),
        EACH(compaction_keeps_order, own),
        EACH(compaction_keeps_order, wide),
        EACH(reductions_agree_with_double, own),
        EACH(reductions_agree_with_double, storage),
        EACH(reductions_agree_with_double, wide),
        EACH(pointers_double_to_their_roots, own),
        EACH(pointers_double_to_their_roots, wide),
        EACH(buffers_beyond_the_storage_range_work, own),
        EACH(every_dispatch_finds_its_own_buffers, own),
        EACH(every_dispatch_finds_its_own_buffers, wide),
        EACH(rounds_after_the_last_are_left_out, own),
        EACH(rounds_after_the_last_are_left_out, unconditional),
        EACH(pointers_double_to_their_roots, unconditional),
        EACH(transfers_are_exact, own),
        EACH(transfers_are_exact, staged),
        EACH(unknown_devices_are_refused, own),
        EACH(a_buffer_too_large_is_refused_with_its_size, own),
        EACH(limits_of_allocations_are_named, own),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
