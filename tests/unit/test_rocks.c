/* Rocks on deposits: where they lie, and that they stay there while what they lie in does. */
#include <math.h>

#include "job_files.h"

#include "base/random.h"
#include "frame/rocks.h"
#include "particles/particles.h"

static const char text[] = "hoodoo: 1\nname: talus\nframes: 1-2\nseed: 3\nclock: {years_per_frame: 1}\n"
                           "domain: {size_m: [30, 24, 20], spacing_m: 0.5}\n"
                           "scene: {box: {min_m: [0, 0, 0], max_m: [30, 24, 2]}}\n"
                           "deposition: {viability: 1, piles: {rock_m: 0.4, rocks: 40}}\n";
enum { NX = 60, NY = 48, NZ = 40, FLOOR = 4 };
static const double H = 0.5;

static struct job *load(const char *job_text)
{
    struct job *job = NULL;
    FILE *f = fopen("talus.yaml", "w");
    assert_non_null(f);
    fputs(job_text, f);
    fclose(f);
    assert_int_equal(job_load("talus.yaml", NULL, 0, &job), OK);
    return job;
}

/* A heap along the middle, `high` voxels; nothing where x is above 20 m. A share of the surface's columns is a
 * voxel lower and as many a voxel higher; grains lie anywhere in their voxels. */
static int heap(int i, int j, int high, double ragged, uint32_t seed)
{
    double rough = (double)random_float(random_hash(seed, (uint32_t)i, (uint32_t)j, 1));
    int h = i < 40 ? high - abs(j - NY / 2) / 2 : 0;
    if (h <= 0)
        return 0;
    return h + (rough < ragged / 2 ? -1 : rough < ragged ? 1 : 0);
}

static void make(int high, double ragged, uint32_t seed, struct rock *rock)
{
    *rock = (struct rock){0};
    assert_int_equal(rock_alloc(rock, NX * NY * NZ, STATE), OK);
    rock->n = 0;
    for (int j = 0; j < NY; j++)
        for (int i = 0; i < NX; i++)
            for (int k = 0; k < FLOOR + heap(i, j, high, ragged, seed); k++) {
                const int x[3] = {i, j, k};
                for (uint32_t a = 0; a < 3; a++)
                    rock->P[4 * rock->n + a] =
                        (float)((x[a] + 0.02 +
                                 0.96 * (double)random_float(random_hash(seed, (uint32_t)rock->n, a, 2))) *
                                H);
                rock->phase[rock->n++] = k < FLOOR ? 0 : PHASE_DEPOSIT;
            }
}

static void place(const struct job *job, const struct pile_tile *tile, int high, double ragged, uint32_t seed,
                  struct frame_rocks *out)
{
    struct rock rock;
    *out = (struct frame_rocks){0};
    make(high, ragged, seed, &rock);
    assert_int_equal(rocks_on_deposits(job, &rock, tile, out), OK);
    rock_free(&rock);
}

static void drop(struct frame_rocks *r)
{
    rock_free(&r->at);
    free(r->box);
}

static bool has(const struct frame_rocks *r, uint32_t id)
{
    for (size_t i = 0; i < r->at.n; i++)
        if (r->at.id[i] == id)
            return true;
    return false;
}

/* How many of a's are not in b. */
static size_t missing(const struct frame_rocks *a, const struct frame_rocks *b)
{
    size_t n = 0;
    for (size_t i = 0; i < a->at.n; i++)
        n += !has(b, a->at.id[i]);
    return n;
}

static void test_where_they_lie(void **state)
{
    (void)state;
    struct job *job = load(text);
    struct pile_tile tile;
    struct frame_rocks rocks;
    double deepest = 0, volume = 0;
    assert_int_equal(rocks_tile(job, &tile), OK);
    place(job, &tile, 16, 0, 1, &rocks);
    assert_true(rocks.wanted && rocks.n_shapes == tile.n && rocks.at.n > 500);
    for (size_t i = 0; i < rocks.at.n; i++) {
        const float *p = rocks.at.P + 4 * i;
        int x = (int)((double)p[0] / H), y = (int)((double)p[1] / H), top = heap(x, y, 16, 0, 1);
        double depth = (FLOOR + top) * H - (double)p[2];
        deepest = fmax(deepest, depth);
        /* In the heap, which is smoothed by a voxel or so at its crest and foot. */
        assert_true((double)p[2] > FLOOR * H && depth > -2 * H && depth < 2 * tile.reach + 2 * H && x <= 41);
        for (size_t k = 0; k < i; k++)
            assert_true(rocks.at.id[k] != rocks.at.id[i]);
        assert_true(rocks.at.layer[i] < tile.n);
    }
    for (int j = 0; j < NY; j++)
        for (int i = 0; i < NX; i++)
            volume += fmin(heap(i, j, 16, 0, 1) * H, 2 * tile.reach) * H * H;
    double expected = volume * (double)tile.n / pow(tile.side, 3);
    print_message(
        "# %zu rocks, %.0f by the volume of the top two diameters; deepest %.2f m, two diameters are "
        "%.2f m\n",
        rocks.at.n, expected, deepest, 2 * tile.reach);
    assert_true(fabs((double)rocks.at.n - expected) < 0.1 * expected);
    drop(&rocks);
    pile_tile_destroy(&tile);
    job_destroy(&job);
}

static void test_they_stay(void **state)
{
    (void)state;
    struct job *job = load(text);
    struct pile_tile tile;
    struct frame_rocks rocks, other;
    assert_int_equal(rocks_tile(job, &tile), OK);
    place(job, &tile, 16, 0, 1, &rocks);
    /* Grains lie otherwise in their voxels: not a rock moves. */
    place(job, &tile, 16, 0, 2, &other);
    assert_int_equal(rocks.at.n, other.at.n);
    assert_memory_equal(rocks.at.P, other.at.P, 16 * rocks.at.n);
    assert_memory_equal(rocks.at.id, other.at.id, 4 * rocks.at.n);
    drop(&other);
    /* A fifth of the surface loses or gains a grain. Were it to be taken as it is, as many rocks as there are
     * within those voxels would come or go. */
    place(job, &tile, 16, 0.2, 3, &other);
    size_t gone = missing(&rocks, &other), come = missing(&other, &rocks);
    print_message("# of %zu rocks %zu go and %zu come as a fifth of the columns changes by a grain\n",
                  rocks.at.n, gone, come);
    assert_true((double)(gone + come) < 0.06 * (double)rocks.at.n);
    drop(&other);
    /* Buried 3 m deeper, other rocks show; dug out again, the same. */
    place(job, &tile, 22, 0, 4, &other);
    assert_true(missing(&other, &rocks) > other.at.n / 4);
    drop(&other);
    place(job, &tile, 16, 0, 5, &other);
    assert_true(missing(&rocks, &other) == 0 && missing(&other, &rocks) == 0);
    drop(&other);
    drop(&rocks);
    pile_tile_destroy(&tile);
    job_destroy(&job);
}

static void test_none_and_too_many(void **state)
{
    (void)state;
    struct job *job = load(text);
    struct pile_tile tile;
    struct frame_rocks rocks;
    assert_int_equal(rocks_tile(job, &tile), OK);
    place(job, &tile, 0, 0, 1, &rocks); /* no deposits yet: a frame without rocks */
    assert_true(rocks.wanted && rocks.at.n == 0);
    drop(&rocks);
    pile_tile_destroy(&tile);
    job->deposition.piles.rock_m = 0;
    assert_null(job_piles(job));
    assert_int_equal(rocks_tile(job, &tile), OK);
    place(job, &tile, 16, 0, 1, &rocks);
    assert_true(tile.n == 0 && !rocks.wanted);
    job->deposition.piles.rock_m = 1e-4;
    assert_int_equal(rocks_tile(job, &tile), E_USAGE);
    assert_true(tile.n == 0 && strstr(status_message(), "rock_m") != NULL);
    /* Arches has them over its rock layers. */
    job->model = MODEL_ARCHES;
    assert_null(job_piles(job));
    job->arches.piles.rock_m = 1;
    assert_ptr_equal(job_piles(job), &job->arches.piles);
    job_destroy(&job);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_where_they_lie),
        cmocka_unit_test(test_they_stay),
        cmocka_unit_test(test_none_and_too_many),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
