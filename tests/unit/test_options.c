/* Command lines: what is understood, and that what is not is refused with a hint. Also progress and signals.
 */
#include <setjmp.h>
#include <signal.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include "base/log.h"
#include "cli/options.h"
#include "system/progress.h"
#include "system/signals.h"

#include <cmocka.h> /* after ours: it has a macro fail() */

static const struct usage usage = {"test", "OUT [FILE]", "a verb for tests"};

struct given {
    struct common common;
    struct arguments operands;
    int size;
    double scale;
    bool help;
};

/* Parses a command line given as words separated by single spaces; the words must outlive what points at
 * them. */
static status parse(const char *line, struct given *g)
{
    static char words[1024];
    char *argv[32] = {0};
    int argc = 0;
    arguments_free(&g->operands);
    common_free(&g->common);
    *g = (struct given){.size = 7};
    snprintf(words, sizeof words, "test %s", line);
    for (char *w = strtok(words, " "); w; w = strtok(NULL, " "))
        argv[argc++] = w;
    const struct option options[] = {
        OPTION_OUT(&g->common),    OPTION_FRAMES(&g->common),
        OPTION_SET(&g->common),    OPTION_PROGRESS(&g->common),
        OPTION_JSON(&g->common),   {"size", "N", OPTION_INT, &g->size, "pixels"},
        OPTION_RESUME(&g->common), {"scale", "X", OPTION_NUMBER, &g->scale, "a factor"},
    };
    return options_parse(&usage, options, sizeof options / sizeof *options, argc, argv, &g->operands,
                         &g->help);
}

static void understands_what_users_write(void **state)
{
    (void)state;
    struct given g = {0};
    assert_int_equal(
        parse("--out a/b here --json --frames=1001-1010x3 --set a.b=1 --set c=[1,2] --size -3", &g), OK);
    assert_string_equal(g.common.out, "a/b");
    assert_int_equal(g.operands.n, 1);
    assert_string_equal(g.operands.item[0], "here");
    assert_true(g.common.json);
    assert_int_equal(g.common.frames.first, 1001);
    assert_int_equal(g.common.frames.step, 3);
    assert_int_equal(g.common.sets.n, 2);
    assert_string_equal(g.common.sets.item[1], "c=[1,2]");
    assert_int_equal(g.size, -3);

    assert_int_equal(parse("here", &g), OK);
    assert_int_equal(g.common.frames.step, 0);
    assert_int_equal(g.size, 7);
    assert_int_equal(g.common.progress, PROGRESS_AUTO);
    assert_int_equal(g.common.resume, RESUME_AUTO);

    assert_int_equal(parse("--frames -5-10 --scale 1e-3 --progress openjd --resume other-device x", &g), OK);
    assert_int_equal(g.common.frames.first, -5);
    assert_true(g.scale == 1e-3);
    assert_int_equal(g.common.progress, PROGRESS_OPENJD);
    assert_int_equal(g.common.resume, RESUME_OTHER_DEVICE);
    assert_int_equal(parse("--resume other-build x", &g), OK);
    assert_int_equal(g.common.resume, RESUME_OTHER_BUILD);
    assert_int_equal(parse("--resume other-device-and-build x", &g), OK);
    assert_int_equal(g.common.resume, RESUME_OTHER_BOTH);

    assert_int_equal(parse("-- --json -x", &g), OK);
    assert_false(g.common.json);
    assert_string_equal(g.operands.item[0], "--json");
    assert_int_equal(parse("--out=--odd= -", &g), OK);
    assert_string_equal(g.common.out, "--odd=");
    assert_string_equal(g.operands.item[0], "-");
    arguments_free(&g.operands);
    common_free(&g.common);
}

static void refuses_the_rest_and_says_why(void **state)
{
    (void)state;
    static const struct {
        const char *line, *says;
    } wrong[] = {
        {"x --fames 1001", "did you mean --frames?"},
        {"x --jsno", "did you mean --json?"},
        {"x -frames 1001", "did you mean --frames?"},
        {"x --frame=1001", "did you mean --frames?"},
        {"x --quux", "'hoodoo test -h' lists them"},
        {"x -q", "unknown option -q"},
        {"x --out", "--out requires a value: --out DIR"},
        {"x --out --json", "--out requires a value"},
        {"x --json=yes", "takes no value"},
        {"x --frames 9-1", "ends before it begins"},
        {"x --frames 1..5", "not a frame range"},
        {"x --size 1.5", "not a whole number"},
        {"x --size 99999999999", "not a whole number"},
        {"x --scale nan", "not a number"},
        {"x --scale 1e999", "not a number"},
        {"x --progress ba", "must be one of auto|bar|plain|openjd|none"},
        {"x --progress bar|plain", "must be one of"},
        {"x --out=", "is empty"},
        {"", "OUT [FILE] is missing"},
        {"x y z", "unexpected argument 'z'"},
    };
    struct given g = {0};
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
        assert_int_equal(parse(wrong[i].line, &g), E_USAGE);
        if (!strstr(status_message(), wrong[i].says))
            fail_msg("'%s' says: %s", wrong[i].line, status_message());
    }
    arguments_free(&g.operands);
    common_free(&g.common);
}

/* What `draw` writes to the file descriptor `fd`, in `out`. */
static void capture(int fd, void (*draw)(void), char *out, size_t size)
{
    FILE *aside = tmpfile();
    assert_non_null(aside);
    fflush(NULL);
    int saved = dup(fd);
    dup2(fileno(aside), fd);
    draw();
    fflush(NULL);
    dup2(saved, fd);
    close(saved);
    rewind(aside);
    out[fread(out, 1, size - 1, aside)] = '\0';
    fclose(aside);
}

static void three_frames(enum progress_style style)
{
    struct progress p;
    progress_begin(&p, style, (struct frame_range){1001, 1008, 1}, 2);
    progress_stage(&p, 1003, "wind");
    progress_frame(&p, 1003, 0.987, "a note\nopenjd_fail: not this");
    log_warn("rain is late");
    progress_frame(&p, 1004, 0.98, NULL);
    progress_end(&p);
    progress_end(&p);
}

static void openjd(void)
{
    three_frames(PROGRESS_OPENJD);
}

static void bar(void)
{
    three_frames(PROGRESS_BAR);
}

static void automatic(void)
{
    three_frames(PROGRESS_AUTO);
}

static void none(void)
{
    three_frames(PROGRESS_NONE);
}

static void progress_for_openjd(void **state)
{
    (void)state;
    char said[4096];
    capture(STDOUT_FILENO, openjd, said, sizeof said);
    const char *one = strstr(said, "openjd_progress: 25.0\n"), *two = strstr(said, "openjd_progress: 37.5\n");
    const char *three = strstr(said, "openjd_progress: 50.0\n");
    assert_true(one && two && three && one < two && two < three);
    assert_non_null(strstr(said, "openjd_status: frame 1003, 3/8, 98.7% of the rock left"));
    assert_null(strstr(said, "\nopenjd_fail"));
}

static void progress_for_people(void **state)
{
    (void)state;
    char said[8192];
    capture(STDERR_FILENO, bar, said, sizeof said);
    assert_non_null(strstr(said, "1003 wind"));
    assert_non_null(strstr(said, "frames/s"));
    /* The log line has a line of its own, and the bar comes back after it. */
    assert_non_null(strstr(said, "\r\033[Khoodoo: warning: rain is late\n\r["));
    for (const char *line = said; line; line = strpbrk(line + 1, "\r\n"))
        assert_true(strcspn(line + 1, "\r\n") <= 79 + strlen("\033[K"));
    assert_int_equal(said[strlen(said) - 1], '\n');

    capture(STDERR_FILENO, automatic, said, sizeof said);
    assert_null(strchr(said, '\r'));
    assert_non_null(strstr(said, "hoodoo: frame 1004, 4/8, 98.0% of the rock left"));

    capture(STDERR_FILENO, none, said, sizeof said);
    assert_string_equal(said, "hoodoo: warning: rain is late\n");
}

static void durations_in_words(void **state)
{
    (void)state;
    char out[32];
    assert_string_equal(duration_text(0.2, out), "0 s");
    assert_string_equal(duration_text(59.9, out), "1 min 0 s");
    assert_string_equal(duration_text(3 * 3600 + 12 * 60 + 5, out), "3 h 12 min");
    assert_string_equal(duration_text(90000, out), "1 d 1 h");
    assert_string_equal(duration_text(-1, out), "0 s");
}

static void signals_ask_for_a_stop(void **state)
{
    (void)state;
    assert_false(stop_requested());
    assert_null(stop_reason());
    signals_install();
    raise(SIGPIPE);
    assert_false(stop_requested());
    raise(SIGUSR1);
    raise(SIGTERM);
    raise(SIGINT);
    raise(SIGTERM);
    assert_true(stop_requested());
    assert_string_equal(stop_reason(), "SIGUSR1");
    signals_reset();
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(understands_what_users_write), cmocka_unit_test(refuses_the_rest_and_says_why),
        cmocka_unit_test(progress_for_openjd),          cmocka_unit_test(progress_for_people),
        cmocka_unit_test(durations_in_words),           cmocka_unit_test(signals_ask_for_a_stop),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
