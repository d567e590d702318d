/* Air by increments against a recount, exactly, in every step and for every bubble; and who is active. */
#include "check.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/random.h"
#include "effort.h"
#include "voxels/voxels.h"

static struct job *job_of(const char *bubble, const char *goblins)
{
    char path[] = "/tmp/hoodoo-voxels.XXXXXX";
    struct job *job = NULL;
    FILE *f = fdopen(mkstemp(path), "w");
    assert_non_null(f);
    fprintf(f,
            "hoodoo: 1\nname: voxels\nmodel: goblins\nframes: 1-2\n"
            "domain: {size_m: [37, 28, 22], spacing_m: 0.5}\n"
            "scene: {box: {min_m: [0, 0, 0], max_m: [37, 28, 22]}}\n"
            "strata: [{to_m: 12, weak_m_per_kyr: 1, bubble: {%s}}, {weak_m_per_kyr: 2, bubble: {%s}}]\n"
            "goblins: {%s}\n",
            bubble, bubble, goblins);
    assert_int_equal(fclose(f), 0);
    assert_ok(job_load(path, NULL, 0, &job));
    unlink(path);
    return job;
}

struct scene {
    struct job *job;
    struct gpu *gpu;
    struct gpu_work *work;
    struct voxels v;
    int n[3];
    uint8_t *rock; /* by ours: 1 rock */
    struct bubble bubble;
};

static size_t at(const struct scene *s, int x, int y, int z)
{
    return ((size_t)z * (size_t)s->n[1] + (size_t)y) * (size_t)s->n[0] + (size_t)x;
}

/* Rock in heaps: a block with balls taken out of it. */
static struct scene begin(const char *bubble, const char *goblins, int variant)
{
    struct scene s = {.job = job_of(bubble, goblins), .n = {74, 56, 44}};
    size_t n = 74 * 56 * 44, words;
    float *share = calloc(n, sizeof *share), *factor = calloc(n, sizeof *factor);
    s.rock = calloc(n, 1);
    for (int z = 0; z < s.n[2]; z++)
        for (int y = 0; y < s.n[1]; y++)
            for (int x = 0; x < s.n[0]; x++) {
                int rock = x > 3 && x < 70 && y > 2 && y < 52 && z < 40;
                for (uint32_t b = 0; b < 12; b++) {
                    int c[3], d2 = 0, r = 4 + (int)(random_hash(b, 9, 0, 0) % 9);
                    const int p[3] = {x, y, z};
                    for (uint32_t a = 0; a < 3; a++) {
                        c[a] = (int)(random_hash(b, a, 1, 0) % (uint32_t)s.n[a]);
                        d2 += (p[a] - c[a]) * (p[a] - c[a]);
                    }
                    rock &= d2 > r * r;
                }
                s.rock[at(&s, x, y, z)] = (uint8_t)rock;
                share[at(&s, x, y, z)] = (float)rock;
                factor[at(&s, x, y, z)] =
                    0.2f + random_float(random_hash((uint32_t)x, (uint32_t)y, (uint32_t)z, 0));
            }
    assert_ok(gpu_create(&(struct gpu_options){.device = "auto", .variant = variant}, &s.gpu));
    voxels_bytes(s.job, s.n, 0, &words);
    assert_ok(gpu_work_create(s.gpu, words, &s.work));
    assert_ok(voxels_create(s.gpu, s.work, s.job, s.n, share, factor, &s.v));
    assert_ok(voxels_rates(s.gpu, &s.v, s.job, 1));
    assert_ok(bubble_create(&s.job->strata[0].bubble, s.job->domain.spacing_m, &s.bubble));
    free(share);
    free(factor);
    return s;
}

static void end(struct scene *s)
{
    voxels_destroy(s->gpu, &s->v);
    gpu_work_destroy(s->gpu, &s->work);
    gpu_destroy(&s->gpu);
    job_destroy(&s->job);
    free(s->rock);
}

static int is_rock(const struct scene *s, int x, int y, int z)
{
    if (z < 0)
        return !s->job->goblins.floats;
    if (x < 0 || y < 0 || x >= s->n[0] || y >= s->n[1] || z >= s->n[2])
        return 0;
    return s->rock[at(s, x, y, z)];
}

static uint32_t air_around(const struct scene *s, int x, int y, int z)
{
    uint32_t air = 0;
    for (int r = 0; r < s->bubble.n_rows; r++)
        for (int dx = s->bubble.row[r].low; dx <= s->bubble.row[r].high; dx++)
            air += !is_rock(s, x + dx, y + s->bubble.row[r].dy, z + s->bubble.row[r].dz);
    return air;
}

static int exposed(const struct scene *s, int x, int y, int z)
{
    int d = s->v.skin;
    for (int dz = -d; dz <= d; dz++)
        for (int dy = -d; dy <= d; dy++)
            for (int dx = -d; dx <= d; dx++)
                if (dx * dx + dy * dy + dz * dz <= d * d && !is_rock(s, x + dx, y + dy, z + dz))
                    return 1;
    return 0;
}

/* Takes what vanished out of our rock, then compares: rock, who is active, and every active voxel's air. */
static size_t compare(struct scene *s)
{
    const struct voxels *v = &s->v;
    size_t n = gpu_buffer_count(v->left), vanished = 0, i = 0;
    float *left = malloc(n * sizeof *left);
    uint32_t *state = malloc(n * 4), *list = malloc((v->n_active + 1) * 4);
    assert_ok(gpu_download(s->gpu, v->left, 0, left, n));
    assert_ok(gpu_download(s->gpu, v->state, 0, state, n));
    assert_ok(gpu_download(s->gpu, v->list, 0, list, v->n_active));
    for (int z = 0; z < s->n[2]; z++)
        for (int y = 0; y < s->n[1]; y++)
            for (int x = 0; x < s->n[0]; x++) {
                uint8_t *rock = &s->rock[at(s, x, y, z)];
                int now = left[voxels_number(v, x, y, z)] > 0;
                assert_true(now <= *rock);
                vanished += (size_t)(*rock - now);
                *rock = (uint8_t)now;
            }
    for (int z = 0; z < s->n[2]; z++)
        for (int y = 0; y < s->n[1]; y++)
            for (int x = 0; x < s->n[0]; x++) {
                size_t number = voxels_number(v, x, y, z);
                if (!s->rock[at(s, x, y, z)] || !exposed(s, x, y, z))
                    continue;
                assert_true(i < v->n_active);
                assert_int_equal(list[i++], number);
                assert_int_equal(state[number] & 0xffff, air_around(s, x, y, z));
            }
    assert_int_equal(i, v->n_active);
    free(left);
    free(state);
    free(list);
    return vanished;
}

static void counts_equal_recounts(const char *bubble, const char *goblins, int variant)
{
    struct scene s = begin(bubble, goblins, variant);
    size_t vanished = 0, cycles = 0;
    assert_int_equal(compare(&s), 0);
    while ((double)vanished < 500 * fmin(effort(), 1)) {
        double passed;
        uint32_t gone;
        assert_ok(voxels_cycle(s.gpu, s.work, &s.v, 0.02, 1e9, &passed, &gone));
        assert_true(passed > 0 && gone > 0);
        assert_int_equal(compare(&s), gone);
        vanished += gone;
        cycles++;
    }
    print_message("# %s: %u voxels in the bubble, %zu vanished in %zu cycles\n", bubble, s.bubble.n, vanished,
                  cycles);
    end(&s);
}

static void increments_equal_recounts_for_every_bubble(void **state)
{
    static const char *const bubbles[][2] = {
        {"radius_m: 0.5", ""},
        {"radius_m: 2", ""},
        {"shape: gumdrop, radius_m: 2.5, base: 0.3", "skin_m: 1.5"},
        {"radius_m: 3.5", "floats: true, skin_m: 2"},
        {"shape: ellipsoid, radius_m: 2, stretch: [1.5, 0.7, 1]", ""},
        {"radius_m: 2, offset: [0.5, -0.3, 0.6]", "skin_m: 0.5"},
    };
    (void)state;
    for (size_t i = 0; i < sizeof bubbles / sizeof *bubbles; i++)
        if (effort_takes(i))
            counts_equal_recounts(bubbles[i][0], bubbles[i][1], 0);
}

static void increments_equal_recounts_in_every_variant(void **state)
{
    (void)state;
    for (int variant = 1; variant <= 3; variant++)
        counts_equal_recounts("radius_m: 1", "", variant);
}

/* From event to event: every cycle takes the next voxel, and none before its time. */
static void events_come_one_by_one(void **state)
{
    (void)state;
    struct scene s = begin("radius_m: 1.5", "", 0);
    double last = 0;
    for (int cycle = 0; cycle < (int)effort_of(20); cycle++) {
        double passed;
        uint32_t gone;
        assert_ok(voxels_cycle(s.gpu, s.work, &s.v, 0, 1e9, &passed, &gone));
        assert_true(passed > 0);
        assert_in_range(gone, 1, 4); /* floats tie now and then */
        assert_int_equal(compare(&s), gone);
        last += passed;
    }
    /* Half the time, half the weathering: a cycle that is cut short loses nobody. */
    double passed;
    uint32_t gone;
    assert_ok(voxels_cycle(s.gpu, s.work, &s.v, 0, 1e-9, &passed, &gone));
    assert_true(passed == 1e-9 && gone == 0 && last > 0);
    end(&s);
}

static void bubbles_that_do_not_fit_are_refused(void **state)
{
    (void)state;
    struct bubble b;
    struct job_bubble job = {.radius_m = 0.4, .stretch = {1, 1, 1}};
    assert_int_equal(bubble_create(&job, 0.5, &b), E_USAGE);
    job.radius_m = 8;
    assert_int_equal(bubble_create(&job, 0.5, &b), E_USAGE);
    job.radius_m = 7.5;
    assert_ok(bubble_create(&job, 0.5, &b));
    assert_int_equal(b.reach, 15);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(increments_equal_recounts_for_every_bubble),
        cmocka_unit_test(increments_equal_recounts_in_every_variant),
        cmocka_unit_test(events_come_one_by_one),
        cmocka_unit_test(bubbles_that_do_not_fit_are_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
