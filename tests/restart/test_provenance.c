/* Checkpoints of another build or device are refused with exit code 7, or accepted on request and recorded in run.json. The test makes them from
 * its own checkpoints by replacing names and hashes. */
#include "check.h"

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

#include "base/build.h"
#include "checkpoint/checkpoint.h"
#include "system/atomic_file.h"

static const char job[] = "hoodoo: 1\n"
                          "name: tiny\n"
                          "frames: 1001-1003\n"
                          "domain: {size_m: [8, 8, 8], spacing_m: 1}\n"
                          "scene: {box: {min_m: [2, 2, 0], max_m: [6, 6, 6]}}\n"
                          "checkpoint: {every: 1}\n";

static void put(const char *path, const char *bytes, size_t n)
{
    FILE *f = fopen(path, "wb");
    assert_non_null(f);
    assert_int_equal(fwrite(bytes, 1, n, f), n);
    assert_int_equal(fclose(f), 0);
}

static char *content(const char *path)
{
    char *bytes = NULL;
    size_t n;
    assert_ok(file_read(path, 1 << 20, &bytes, &n));
    return bytes;
}

static bool holds(const char *path, const char *text)
{
    char *bytes = content(path);
    bool found = strstr(bytes, text) != NULL;
    if (!found)
        print_error("%s has no \"%s\":\n%s\n", path, text, bytes);
    free(bytes);
    return found;
}

/* Runs hoodoo with its output in the file `said`. Returns the exit code. */
static int shell(const char *format, ...) PRINTF_LIKE(1, 2);
static int shell(const char *format, ...)
{
    char command[1024];
    va_list args;
    va_start(args, format);
    vsnprintf(command, sizeof command, format, args);
    va_end(args);
    int code = system(command);
    assert_true(WIFEXITED(code));
    return WEXITSTATUS(code);
}

static int run(const char *options)
{
    return shell("\"$HOODOO\" run tiny.yaml --out x --progress none %s >said 2>&1", options);
}

/* Makes x: the run up to frame 1002, with a modified checkpoint of that frame. */
static void begin(const char *build, const char *commit, const char *device)
{
    struct checkpoint c;
    char *bytes = NULL;
    size_t n;
    assert_int_equal(
        shell("rm -rf x && cp -r whole x && rm x/frames/tiny.1003.json x/checkpoint/tiny.1003.ckpt"), 0);
    assert_ok(checkpoint_read("x/checkpoint/tiny.1002.ckpt", &c));
    assert_string_equal(c.maker.build, hoodoo_build);
    if (build)
        snprintf(c.maker.build, sizeof c.maker.build, "%s", build);
    if (commit)
        snprintf(c.maker.commit, sizeof c.maker.commit, "%s", commit);
    if (device)
        snprintf(c.maker.device, sizeof c.maker.device, "%s", device);
    assert_ok(checkpoint_encode(&c, &bytes, &n));
    put("x/checkpoint/tiny.1002.ckpt", bytes, n);
    free(bytes);
    checkpoint_free(&c);
}

static int once(void **state)
{
    (void)state;
    put("tiny.yaml", job, sizeof job - 1);
    if (shell("\"$HOODOO\" run tiny.yaml --out whole --progress none") != 0)
        return 1;
    return 0;
}

static void same_build(void **state)
{
    (void)state;
    assert_int_equal(strlen(hoodoo_build), 16);
    assert_int_equal(strspn(hoodoo_build, "0123456789abcdef"), 16);
    assert_int_equal(shell("\"$HOODOO\" --version >said"), 0);
    assert_true(holds("said", hoodoo_build));
    assert_int_equal(shell("\"$HOODOO\" inspect whole/checkpoint/tiny.1003.ckpt >said"), 0);
    assert_true(holds("said", hoodoo_build));
    assert_true(holds("whole/run.json", hoodoo_build));
    /* Another commit of the same code makes no difference. */
    begin(NULL, "deadbeef0000", NULL);
    assert_int_equal(run(""), 0);
    assert_int_equal(shell("grep -q deadbeef0000 said x/run.json"), 1);
    assert_int_equal(shell("diff -r whole/volumes x/volumes && diff -r whole/run.json x/run.json"), 0);
}

static void other_build(void **state)
{
    (void)state;
    begin("00000000deadbeef", NULL, NULL);
    assert_int_equal(run(""), 7);
    assert_true(holds("said", "other-build"));
    assert_true(holds("said", "00000000deadbeef"));
    assert_int_equal(run("--resume other-device"), 7);
    assert_true(holds("said", "other-build"));
    assert_int_equal(access("x/frames/tiny.1003.json", F_OK), -1);
    assert_int_equal(run("--resume other-build"), 0);
    assert_true(holds("said", "not bit for bit"));
    assert_true(holds("x/run.json", "\"continued\": [\n    {\n      \"frame\": 1002,"));
    assert_true(holds("x/run.json", "\"build\": \"00000000deadbeef\""));
    /* The entry remains in run.json and is not duplicated. */
    assert_int_equal(shell("rm x/frames/tiny.1003.json"), 0);
    assert_int_equal(run(""), 0);
    assert_int_equal(shell("test $(grep -c 00000000deadbeef x/run.json) = 1"), 0);
    /* Starting over is always allowed. */
    assert_int_equal(run("--resume never"), 0);
    assert_int_equal(shell("grep -q continued x/run.json"), 1);
    /* Version 0.1.0 had no build. */
    begin("", NULL, NULL);
    assert_int_equal(run(""), 7);
    assert_true(holds("said", "build unknown"));
}

static void other_device(void **state)
{
    (void)state;
    begin(NULL, NULL, "a better one");
    assert_int_equal(run(""), 7);
    assert_true(holds("said", "other-device"));
    assert_int_equal(run("--resume other-build"), 7);
    assert_int_equal(run("--resume other-device"), 0);
    assert_true(holds("x/run.json", "\"device\": \"a better one\""));
    begin("00000000deadbeef", NULL, "a better one");
    assert_int_equal(run("--resume other-build"), 7);
    assert_int_equal(run("--resume other-device"), 7);
    assert_true(holds("said", "--resume other-device-and-build"));
    assert_int_equal(run("--resume other-device-and-build"), 0);
    assert_true(holds("x/run.json", "\"build\": \"00000000deadbeef\""));
}

/* Another build cannot make frames again either if their checkpoints are lost. */
static void without_checkpoints(void **state)
{
    (void)state;
    begin(NULL, NULL, NULL);
    assert_int_equal(shell("rm x/checkpoint/* && sed -i 's/%s/00000000deadbeef/' x/run.json", hoodoo_build),
                     0);
    assert_int_equal(run(""), 7);
    assert_true(holds("said", "other-build"));
    assert_int_equal(run("--resume other-build"), 0);
    assert_true(holds("x/run.json", "\"frame\": 1001"));
    assert_true(holds("x/run.json", "00000000deadbeef"));
}

static void branches(void **state)
{
    (void)state;
    begin("00000000deadbeef", NULL, NULL);
    assert_int_equal(shell("\"$HOODOO\" run tiny.yaml --out b --from x@1002 --progress none >said 2>&1"), 7);
    assert_true(holds("said", "other-build"));
    assert_int_equal(
        shell("\"$HOODOO\" run tiny.yaml --out b --from x@1002 --progress none --resume other-build "
              ">said 2>&1"),
        0);
    assert_true(holds("b/run.json", "00000000deadbeef"));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(same_build), cmocka_unit_test(other_build),         cmocka_unit_test(other_device),
        cmocka_unit_test(branches),   cmocka_unit_test(without_checkpoints),
    };
    return cmocka_run_group_tests(tests, once, NULL);
}
