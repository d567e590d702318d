/* NaN and 1e30 are planted in everything that lasts from stage to stage, on the device, between any two stages of a frame, in each model:
 * the frame in which they appear ends with E_NUMERIC, what, where and after which stage is said, and the checkpoints before stay sound. */
#include "base/hash.h"
#include "base/random.h"
#include "checkpoint/checkpoint.h"
#include "effort.h"
#include "model/numbers.h"
#include "model_help.h"
#include "output/folder.h"
#include "run/run.h"

#include <math.h>
#include <string.h>

/* ---- what is planted */

static struct plan {
    bool on;
    int skip;        /* ends of stages before it */
    uint64_t number; /* says which item of what, and where in it */
    float value;
    bool planted;
    char name[64], stage[64];
} plan;

static void plant(struct gpu *gpu, const struct watch_list *list)
{
    if (!plan.on || list->n == 0 || plan.skip-- > 0)
        return;
    const struct watched *w = &list->item[plan.number % list->n];
    const size_t at = (plan.number >> 8) % w->n;
    float value[4];
    plan.on = false;
    assert_ok(gpu_download(gpu, w->buffer, at, value, 1));
    value[gpu_buffer_item(w->buffer) == 16 ? (plan.number >> 40) % 3 : 0] = plan.value;
    assert_ok(gpu_upload(gpu, w->buffer, at, value, 1));
    plan.planted = true;
    snprintf(plan.name, sizeof plan.name, "%s", w->name);
    snprintf(plan.stage, sizeof plan.stage, "'%s'", list->stage);
}

static uint64_t draw(int number, int what)
{
    return (uint64_t)random_hash(77, (uint32_t)number, (uint32_t)what, 1) << 32 |
           random_hash(77, (uint32_t)number, (uint32_t)what, 2);
}

static void plan_for(int number, int stages)
{
    plan = (struct plan){.on = true,
                         .skip = (int)(draw(number, 0) % (uint64_t)stages),
                         .number = draw(number, 1),
                         .value = number % 2 ? 1e30F : (float)NAN};
}

/* ---- the jobs */

#define SCENE                                                                                                \
    "domain: {size_m: [8, 8, 8], spacing_m: 1}\n"                                                            \
    "scene: {union: [{box: {min_m: [1, 1, 2], max_m: [7, 7, 6]}}, {box: {min_m: [2, 2, 0], max_m: [5, 6, "   \
    "2]}}]}\n"                                                                                               \
    "cameras: {main: {orbit: {target_m: [4, 4, 3], distance_m: 20}, resolution: [16, 9]}}\n"                 \
    "output: {aov: {cameras: [main]}}\ncheckpoint: {every: 1, keep: 9}\nseed: 3\n"
static const struct {
    const char *name, *text;
} jobs[] = {
    {"weather",
     "hoodoo: 1\nname: weather\nframes: 1001-1002\n" SCENE
     "rain: {m_per_yr: 0.5}\ndeposition: {viability: 1}\npaint: [{noise: {scale_m: 4}, vegetation: 0.5}]\n"
     "strata: [{weak_m_per_kyr: 0.2, strong_m_per_kyr: 0.02, interlock_MPa: 0.1}]\n"},
    {"air", "hoodoo: 1\nname: air\nframes: 1001-1002\nwind: {flow: {solver: sph, spacing_m: 3, flushes: 1}, "
            "abrasion: 0.5}\n" SCENE},
    {"fall", "hoodoo: 1\nname: fall\nframes: 1001-1002\nclock: {seconds_per_frame: 0.02}\n" SCENE},
    {"goblin", "hoodoo: 1\nname: goblin\nmodel: goblins\nframes: 1001-1002\ngoblins: {stress: true}\n" SCENE},
    {"arch", "hoodoo: 1\nname: arch\nmodel: arches\nframes: 1001-1002\n" SCENE},
};
enum { JOBS = sizeof jobs / sizeof *jobs };

static void write_job(int which, char path[64])
{
    snprintf(path, 64, "%s.yaml", jobs[which].name);
    FILE *file = fopen(path, "w");
    assert_non_null(file);
    assert_true(fputs(jobs[which].text, file) >= 0);
    assert_int_equal(fclose(file), 0);
}

static status run_into(int which, const char *root)
{
    char path[64];
    struct job *job = NULL;
    write_job(which, path);
    assert_ok(job_load(path, NULL, 0, &job));
    const status st = run_job(job, &(struct run_options){.root = root});
    job_destroy(&job);
    return st;
}

/* ---- the run */

static int n_ends; /* of stages */
static int all_planted;

static void count(struct gpu *gpu, const struct watch_list *list)
{
    (void)gpu;
    n_ends += list->n > 0;
}

static void same_file(const char *a, const char *b, const char *below)
{
    char path[2][PATH_BYTES + 64];
    uint64_t hash[2], size[2];
    for (int i = 0; i < 2; i++) {
        snprintf(path[i], sizeof path[i], "%s/%s", i ? b : a, below);
        assert_ok(hash_file(path[i], &hash[i], &size[i]));
    }
    assert_true(hash[0] == hash[1]);
}

/* All that a frame's manifest lists is in it: equal manifests are equal frames. */
static void same_frames(const char *a, const char *b, const char *name)
{
    int *frame[2];
    size_t n[2];
    assert_ok(folder_frames(a, name, &frame[0], &n[0]));
    assert_ok(folder_frames(b, name, &frame[1], &n[1]));
    assert_true(n[0] == n[1]);
    for (size_t i = 0; i < n[0]; i++) {
        struct path path;
        assert_ok(folder_name(&path, name, FILE_MANIFEST, frame[0][i], NULL));
        same_file(a, b, path.text);
    }
    free(frame[0]);
    free(frame[1]);
}

/* Every checkpoint of the folder can be read. */
static void sound_checkpoints(const char *root, const char *name)
{
    int *frame = NULL;
    size_t n;
    assert_ok(checkpoint_list(root, name, &frame, &n));
    for (size_t i = 0; i < n; i++) {
        struct path path;
        struct checkpoint c;
        assert_ok(folder_path(&path, root, name, FILE_CHECKPOINT, frame[i], NULL));
        assert_ok(checkpoint_read(path.text, &c));
        checkpoint_free(&c);
    }
    free(frame);
}

static void plant_in(int which)
{
    char whole[64], root[64];
    const int tries = (int)effort_of(1);
    snprintf(whole, sizeof whole, "whole.%s", jobs[which].name);
    n_ends = 0;
    numbers_plant = count;
    assert_ok(run_into(which, whole));
    assert_true(n_ends > 3);
    numbers_plant = plant;
    int n_planted = 0;
    for (int i = 0; i < tries; i++) {
        plan_for(i + 1000 * which, n_ends);
        snprintf(root, sizeof root, "%s.%d", jobs[which].name, i);
        const status st = run_into(which, root);
        if (!plan.planted) {
            assert_ok(st);
            continue;
        }
        n_planted++;
        if (st != E_NUMERIC || !strstr(status_message(), plan.name) ||
            !strstr(status_message(), plan.stage)) {
            print_error("%s: %g in %s after stage %s: %d: %s", jobs[which].name, (double)plan.value,
                        plan.name, plan.stage, (int)st, status_message());
            _fail(__FILE__, __LINE__);
        }
        if (i == 0)
            print_message("# %s\n", status_message());
        sound_checkpoints(root, jobs[which].name);
        /* And the same command goes on to the same frames. */
        if (i % 3 == 0 && (which == 0 || effort() > 1)) {
            assert_ok(run_into(which, root));
            same_frames(whole, root, jobs[which].name);
        }
    }
    print_message("# %s: %d planted, none lost\n", jobs[which].name, n_planted);
    assert_true(n_planted * 2 >= tries);
    all_planted += n_planted;
    if (which == JOBS - 1)
        print_message(
            "# fault | NaN and 1e30 planted on the device between stages, in all models | %d | exit code 8 "
            "in that frame, with stage "
            "and place; checkpoints are sound, and the same command ends with the same bytes | 0 |\n",
            all_planted);
    numbers_plant = NULL;
}

#define TEST(i)                                                                                              \
    static void job_##i(void **state)                                                                        \
    {                                                                                                        \
        (void)state;                                                                                         \
        plant_in(i);                                                                                         \
    }
TEST(0)
TEST(1)
TEST(2)
TEST(3)
TEST(4)

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(job_0), cmocka_unit_test(job_1),
                                       cmocka_unit_test(job_2), cmocka_unit_test(job_3),
                                       cmocka_unit_test(job_4)};
    return cmocka_run_group_tests_name("numbers", tests, NULL, NULL);
}
