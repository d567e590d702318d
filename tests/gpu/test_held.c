/* Voxels kept as bits: which are held, in what order, and that memory follows them and not the box. */
#include "check.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "particles/held.h"
#include "particles/particles.h"

static uint32_t noise(uint32_t *state)
{
    *state = *state * 747796405u + 2891336453u;
    return *state >> 8;
}

struct bed {
    struct gpu *gpu;
    struct gpu_work *work;
    struct held_voxels held;
    uint32_t *occupied;
};

static size_t words_across(const int n[3])
{
    return ((size_t)n[0] + 31) / 32;
}

static size_t word_of(const int n[3], const int v[3])
{
    return ((size_t)v[2] * (size_t)n[1] + (size_t)v[1]) * words_across(n) + (size_t)v[0] / 32;
}

static bool occupied(const struct bed *b, const int v[3])
{
    const int *n = b->held.voxels;
    for (int a = 0; a < 3; a++)
        if (v[a] < 0 || v[a] >= n[a])
            return false;
    return b->occupied[word_of(n, v)] >> (v[0] % 32) & 1;
}

static bool near(const struct bed *b, const int v[3])
{
    for (int i = 0; i < 27; i++)
        if (occupied(b, (const int[]){v[0] + i % 3 - 1, v[1] + i / 3 % 3 - 1, v[2] + i / 9 - 1}))
            return true;
    return false;
}

/* `one_in`: a voxel is occupied by chance. */
static struct bed bed_create(const int n[3], uint32_t one_in)
{
    struct bed b = {0};
    uint32_t random = 1;
    assert_ok(gpu_create(&(struct gpu_options){.device = "auto"}, &b.gpu));
    assert_ok(gpu_work_create(b.gpu, voxel_count(n) + 2, &b.work));
    assert_ok(held_create(b.gpu, n, 0, &b.held));
    b.occupied = calloc(held_words(n), sizeof *b.occupied);
    assert_non_null(b.occupied);
    for (int z = 0; z < n[2]; z++)
        for (int y = 0; y < n[1]; y++)
            for (int x = 0; x < n[0]; x++)
                if (noise(&random) % one_in == 0)
                    b.occupied[word_of(n, (const int[]){x, y, z})] |= 1U << (x % 32);
    return b;
}

static void bed_free(struct bed *b)
{
    held_destroy(b->gpu, &b->held);
    gpu_work_destroy(b->gpu, &b->work);
    gpu_destroy(&b->gpu);
    free(b->occupied);
}

/* Slots number the held voxels upwards; the list has each one's word and bit. */
static void check_held(struct bed *b, bool around)
{
    const int *n = b->held.voxels;
    const size_t words = held_words(n);
    uint32_t *word = calloc(HELD_STRIDE * (words + 1), 4), *list;
    size_t slot = 0;
    assert_ok(held_occupy(b->gpu, &b->held, b->occupied));
    assert_ok(held_find(b->gpu, b->work, &b->held, around));
    assert_true(b->held.n <= b->held.room);
    list = calloc(b->held.n + 1, 4);
    assert_ok(gpu_download(b->gpu, b->held.words, 0, word, HELD_STRIDE * (words + 1)));
    assert_ok(gpu_download(b->gpu, b->held.list, 0, list, b->held.n));
    for (int z = 0; z < n[2]; z++)
        for (int y = 0; y < n[1]; y++)
            for (int x = 0; x < n[0]; x++) {
                const int v[3] = {x, y, z};
                const size_t w = word_of(n, v);
                const bool is = around ? near(b, v) : occupied(b, v);
                if (x % 32 == 0)
                    assert_int_equal(word[HELD_STRIDE * w + 1], slot);
                assert_int_equal(word[HELD_STRIDE * w] >> (x % 32) & 1, is);
                if (is)
                    assert_int_equal(list[slot++], 32 * w + (size_t)(x % 32));
            }
    assert_int_equal(slot, b->held.n);
    assert_int_equal(word[HELD_STRIDE * words], 0);
    assert_int_equal(word[HELD_STRIDE * words + 1], slot);
    free(word);
    free(list);
}

static void held_voxels_are_numbered_upwards(void **state)
{
    static const int sizes[][3] = {{70, 9, 5}, {64, 6, 7}, {1, 1, 1}, {31, 4, 40}, {33, 1, 3}};
    (void)state;
    for (size_t i = 0; i < sizeof sizes / sizeof *sizes; i++)
        for (uint32_t one_in = 1; one_in < 200; one_in *= 7) {
            struct bed b = bed_create(sizes[i], one_in);
            check_held(&b, false);
            check_held(&b, true);
            check_held(&b, false);
            bed_free(&b);
        }
}

static void all_may_be_held(void **state)
{
    static const int n[3] = {45, 3, 6};
    struct bed b = bed_create(n, 1000);
    (void)state;
    assert_ok(held_all(b.gpu, b.work, &b.held));
    assert_int_equal(b.held.n, voxel_count(n));
    bed_free(&b);
}

/* Rock that fills less than a twentieth of its box: a bit more. */
static void memory_follows_the_rock(void **state)
{
    static const int tight[3] = {100, 100, 100}, wide[3] = {200, 250, 400};
    const double ratio = (double)particles_bytes(900000, wide) / (double)particles_bytes(900000, tight);
    (void)state;
    print_message("# the particles of a twentieth of the box take %.3f of what they take alone\n", ratio);
    assert_true(ratio < 1.1);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(held_voxels_are_numbered_upwards),
        cmocka_unit_test(all_may_be_held),
        cmocka_unit_test(memory_follows_the_rock),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
