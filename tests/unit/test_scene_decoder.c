/* The image decoder's child process: whatever a decoder does, the parent gets an answer. This test brings its
 * own image_decode(), which does what the file's name says. */
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "scene/image.h"
#include "scene/image_shim.h"

status image_decode(const char *path, size_t max_pixels, size_t *width, size_t *height, float **value)
{
    if (strstr(path, "crash")) {
        signal(SIGSEGV, SIG_DFL); /* sanitizers catch it */
        raise(SIGSEGV);
    }
    if (strstr(path, "slow"))
        raise(SIGXCPU);
    if (strstr(path, "silent"))
        _exit(0);
    *width = strstr(path, "absurd") ? max_pixels : 1000;
    *height = 1000;
    *value = calloc(1000 * 1000, sizeof **value);
    if (strstr(path, "greedy")) {
        char *much = malloc((size_t)6 << 30);
        if (!much)
            return fail(E_INPUT, "%s: no memory", path);
        free(much);
    }
    if (strstr(path, "chatty"))
        for (int i = 0; i < 100000; i++)
            fprintf(stderr, "ok 99 - not for the log\n");
    for (int i = 0; i < 1000 * 1000; i++)
        (*value)[i] = (float)i;
    return OK;
}

#include "scene_help.h" /* after the use of fail() */

static void a_child_that_fails_is_an_error(void **state)
{
    (void)state;
    static const char *const expected[][2] = {{"crash", "crashed (Segmentation fault)"},
                                              {"slow", "too long"},
                                              {"silent", "without a word"},
                                              {"absurd", "no sense"}};
    size_t width, height;
    float *value;
    for (size_t i = 0; i < sizeof expected / sizeof *expected; i++) {
        char *path = write_text(expected[i][0], "x");
        assert_failed(image_read(path, &width, &height, &value), E_INPUT, expected[i][0], expected[i][1]);
        assert_null(value);
    }
}

static void a_greedy_child_gets_no_memory(void **state)
{
    (void)state;
#if defined(__SANITIZE_ADDRESS__)
    return; /* no limit on address space there; cmocka's skip() would say "not ok" */
#endif
    size_t width, height;
    float *value;
    assert_failed(image_read(write_text("greedy", "x"), &width, &height, &value), E_INPUT, "greedy",
                  "no memory");
}

static void large_answers_arrive_whole(void **state)
{
    (void)state;
    size_t width, height;
    float *value;
    assert_int_equal(image_read(write_text("chatty", "x"), &width, &height, &value), OK);
    assert_true(width == 1000 && height == 1000);
    for (int i = 0; i < 1000 * 1000; i++)
        assert_true(value[i] == (float)i);
    free(value);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_child_that_fails_is_an_error),
        cmocka_unit_test(a_greedy_child_gets_no_memory),
        cmocka_unit_test(large_answers_arrive_whole),
    };
    cmocka_set_message_output(CM_OUTPUT_TAP);
    return cmocka_run_group_tests(tests, NULL, remove_files);
}
