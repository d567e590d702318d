/* Paths are whole or refused, and numbers in names read as they are written. */
#include <limits.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include "base/path.h"

#include <cmocka.h> /* after ours: it has a macro fail() */

static void numbers_have_a_sign_and_four_digits(void **state)
{
    (void)state;
    static const struct {
        int frame;
        const char *text;
    } frames[] = {{1001, "1001"},   {7, "0007"},      {0, "0000"},        {-12, "-0012"},      {-1, "-0001"},
                  {12345, "12345"}, {-9999, "-9999"}, {-12345, "-12345"}, {9999999, "9999999"}};
    char out[FRAME_TEXT];
    int back;
    for (size_t i = 0; i < sizeof frames / sizeof *frames; i++) {
        assert_string_equal(frame_text(frames[i].frame, out), frames[i].text);
        assert_true(frame_parse(out, strlen(out), &back));
        assert_int_equal(back, frames[i].frame);
    }
    assert_string_equal(frame_text(INT_MIN, out), "-2147483648");
    assert_string_equal(wedge_text(1, out), "w0001");
    assert_string_equal(wedge_text(WEDGE_MAX, out), "w9999");
}

static void other_spellings_are_no_frames(void **state)
{
    (void)state;
    static const char *const others[] = {"",      "-",     "12",     "-12",         "-012",    "+0012",
                                         "-0000", "00012", " 0012",  "0012 ",       "0x12",    "012a",
                                         "1e03",  "--012", "-00012", "99999999999", "1001.vdb"};
    int frame = 77;
    for (size_t i = 0; i < sizeof others / sizeof *others; i++)
        if (frame_parse(others[i], strlen(others[i]), &frame))
            fail_msg("'%s' was read as frame %d", others[i], frame);
    assert_int_equal(frame, 77);
    assert_true(frame_parse("-0012.vdb", 5, &frame));
    assert_int_equal(frame, -12);
}

static void paths_join(void **state)
{
    (void)state;
    struct path p;
    assert_int_equal(path_join(&p, "out", "log/run.log"), OK);
    assert_string_equal(p.text, "out/log/run.log");
    assert_int_equal(path_join(&p, p.text, "x"), OK);
    assert_string_equal(p.text, "out/log/run.log/x");
    assert_int_equal(path_format(&p, "%s.%d.%s", p.text, 3, "png"), OK);
    assert_string_equal(p.text, "out/log/run.log/x.3.png");
    assert_string_equal(path_last(p.text), "x.3.png");
    assert_string_equal(path_last("x.png"), "x.png");
    assert_int_equal(path_wedge(&p, "out", 12), OK);
    assert_string_equal(p.text, "out/w0012");
    assert_int_equal(path_wedge(&p, "out", 0), OK);
    assert_string_equal(p.text, "out");
}

static void a_path_has_a_folder(void **state)
{
    (void)state;
    struct path p;
    assert_int_equal(path_folder(&p, "a/b/c.vdb"), OK);
    assert_string_equal(p.text, "a/b");
    assert_int_equal(path_folder(&p, "/c.vdb"), OK);
    assert_string_equal(p.text, "/");
    assert_int_equal(path_folder(&p, "c.vdb"), OK);
    assert_string_equal(p.text, ".");
}

/* To the byte: 4,095 of them are a path that the system opens, 4,096 are not. */
static void what_does_not_fit_is_refused(void **state)
{
    (void)state;
    struct path p;
    char folder[PATH_BYTES];
    memset(folder, 'a', sizeof folder);
    folder[PATH_BYTES - 3] = '\0'; /* 4,093 and "/b" */
    assert_int_equal(path_join(&p, folder, "b"), OK);
    assert_int_equal(strlen(p.text), PATH_BYTES - 1);
    assert_int_equal(path_join(&p, folder, "bc"), E_OUTPUT);
    assert_string_equal(p.text, "");
    assert_non_null(strstr(status_message(), "4096 bytes"));
    assert_non_null(strstr(status_message(), "the limit is 4095"));
    assert_int_equal(path_wedge(&p, folder, 1), E_OUTPUT);
    assert_string_equal(p.text, "");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(numbers_have_a_sign_and_four_digits),
        cmocka_unit_test(other_spellings_are_no_frames),
        cmocka_unit_test(paths_join),
        cmocka_unit_test(a_path_has_a_folder),
        cmocka_unit_test(what_does_not_fit_is_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
