/* The USD stage of a run that goes on: it names the frames that are there, and reads each manifest once. */
#include "check.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/hash.h"
#include "frame/stage.h"
#include "output/folder.h"
#include "system/atomic_file.h"

enum { HASH = 77 };

static const char yaml[] = "hoodoo: 1\nname: rock\nframes: 1001-1009\nclock: {years_per_frame: 10}\n"
                           "domain: {size_m: [4, 4, 4], spacing_m: 1}\n"
                           "scene: {box: {min_m: [1, 1, 0], max_m: [3, 3, 3]}}\n";

static void add_frame(int number)
{
    struct manifest_file file = {0};
    struct manifest m = {
        .frame = number, .job_hash = HASH, .n_files = 1, .file = &file, .start_volume_m3 = 1};
    struct path path;
    snprintf(file.path, sizeof file.path, "points/rock.%d.usdc", number);
    assert_ok(path_format(&path, "out/%s", file.path));
    assert_ok(atomic_file_write(path.text, "points", 6));
    assert_ok(hash_file(path.text, &file.hash, &file.size));
    assert_ok(manifest_write("out", "rock", &m));
}

static void damage(int number)
{
    struct path path;
    assert_ok(folder_path(&path, "out", "rock", FILE_MANIFEST, number, NULL));
    FILE *f = fopen(path.text, "w");
    assert_non_null(f);
    fputs("{", f);
    fclose(f);
}

/* Does the stage name the frame's file? */
static bool names(int number)
{
    char file[64], *bytes = NULL;
    size_t n;
    snprintf(file, sizeof file, "rock.%d.usdc", number);
    assert_ok(file_read("out/rock.usda", 1 << 20, &bytes, &n));
    const bool found = strstr(bytes, file) != NULL;
    free(bytes);
    return found;
}

static void known_frames_are_not_read_again(void **state)
{
    (void)state;
    struct job *job = NULL;
    struct stage_frames known = {0};
    struct path path;
    assert_ok(atomic_file_write("rock.yaml", yaml, sizeof yaml - 1));
    assert_ok(job_load("rock.yaml", NULL, 0, &job));
    assert_ok(folder_prepare("out"));
    assert_ok(stage_write(job, &(struct job_states){.job = HASH}, "out", &known));
    assert_int_equal(known.n, 0);

    add_frame(1001);
    add_frame(1003);
    assert_ok(stage_write(job, &(struct job_states){.job = HASH}, "out", &known));
    assert_true(names(1001) && names(1003) && !names(1002));

    /* One between them; one that cannot be read now, and one that is gone. */
    add_frame(1002);
    add_frame(1004);
    damage(1003);
    assert_ok(folder_path(&path, "out", "rock", FILE_MANIFEST, 1001, NULL));
    assert_int_equal(unlink(path.text), 0);
    assert_ok(stage_write(job, &(struct job_states){.job = HASH}, "out", &known));
    assert_int_equal(known.n, 3);
    assert_true(!names(1001) && names(1002) && names(1003) && names(1004));

    /* Without what was known, all are read; a frame that cannot be read would be missing from the sequence. */
    assert_int_equal(stage_write(job, &(struct job_states){.job = HASH}, "out", NULL), E_INPUT);
    assert_non_null(strstr(status_message(), "rock.1003.json"));
    assert_true(names(1003));
    add_frame(1003);
    assert_ok(stage_write(job, &(struct job_states){.job = HASH}, "out", NULL));
    assert_true(!names(1001) && names(1002) && names(1003) && names(1004));
    assert_ok(stage_write(job, &(struct job_states){.job = HASH + 1}, "out", NULL));
    assert_true(names(1004)); /* of another job: nothing is written */
    stage_frames_free(&known);
    job_destroy(&job);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(known_frames_are_not_read_again)};
    return cmocka_run_group_tests_name("stage", tests, NULL, NULL);
}
