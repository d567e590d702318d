/* Child processes: what they are given, how they end, and that none is left behind. */
#include <fcntl.h>
#include <setjmp.h>
#include <signal.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

#include "base/clock.h"
#include "system/child.h"

/* After the use of fail(). */
#include <cmocka.h>

#define SH(...)                                                                                              \
    (const char *const[])                                                                                    \
    {                                                                                                        \
        "/bin/sh", "-c", __VA_ARGS__, NULL                                                                   \
    }

static int run(struct child_options options)
{
    struct child child = {0};
    int how = -1;
    assert_int_equal(child_start(&options, &child), OK);
    assert_int_equal(child_wait(&child, 1, 60, &how), 0);
    assert_int_equal(child.pid, 0);
    return how;
}

static void ends_are_told(void **state)
{
    (void)state;
    signal(SIGCHLD, SIG_IGN); /* as whoever starts us may leave it */
    assert_int_equal(WEXITSTATUS(run((struct child_options){.argv = SH("exit 7")})), 7);
    int how = run((struct child_options){.argv = SH("kill -SEGV $$")});
    assert_true(WIFSIGNALED(how) && WTERMSIG(how) == SIGSEGV);
    const char *const none[] = {"no-such-program-here", NULL};
    assert_int_equal(WEXITSTATUS(run((struct child_options){.argv = none})), CHILD_NO_PROGRAM);
    assert_int_equal(
        WEXITSTATUS(run((struct child_options){.argv = SH("exit 0"), .folder = "no/such/folder"})),
        CHILD_NOT_SET_UP);
}

static void logs_grow_and_their_last_words_are_the_reason(void **state)
{
    (void)state;
    char why[600];
    run((struct child_options){.argv = SH("echo hoodoo: one; pwd"), .folder = "/", .log = "/dev/null"});
    run((struct child_options){.argv = SH("echo 'hoodoo: one' >&2"), .log = "a.log"});
    int how =
        run((struct child_options){.argv = SH("echo 'hoodoo: two'; echo three; exit 4"), .log = "a.log"});
    child_reason(how, "a.log", why, sizeof why);
    assert_string_equal(why, "exit 4: two");
    child_reason(SIGKILL, "none.log", why, sizeof why);
    assert_non_null(strstr(why, "signal 9"));
}

/* It finds nothing of ours but what it is passed, in order, even where the places are taken by one another. */
static void descriptors_are_passed(void **state)
{
    (void)state;
    int four = open("four", O_RDWR | O_CREAT, 0666), three = open("three", O_RDWR | O_CREAT, 0666);
    int leaked = open("leaked", O_RDWR | O_CREAT, 0666);
    assert_true(leaked > 0);
    const int pass[] = {three, four};
    int how = run((struct child_options){
        .argv = SH("echo 3 >&3; echo 4 >&4; for f in 5 6 7 8 9; do [ -e /proc/self/fd/$f ] && exit 1; done; "
                   "read line && exit 2; exit 0"),
        .pass = pass,
        .n_pass = 2});
    assert_int_equal(how, 0);
    char text[3] = {0};
    assert_int_equal(pread(three, text, 2, 0), 2);
    assert_string_equal(text, "3\n");
    assert_int_equal(pread(four, text, 2, 0), 2);
    assert_string_equal(text, "4\n");
    close(three);
    close(four);
    close(leaked);
}

static void variables_do_not_replace_the_users(void **state)
{
    (void)state;
    const struct child_variable variable[] = {{"HOODOO_TEST_A", "new"}, {NULL, ""}, {"HOODOO_TEST_B", "new"}};
    setenv("HOODOO_TEST_A", "users", 1);
    int how = run((struct child_options){.argv = SH("[ $HOODOO_TEST_A = users ] && [ $HOODOO_TEST_B = new ]"),
                                         .variable = variable,
                                         .n_variables = 3});
    assert_int_equal(how, 0);
    assert_null(getenv("HOODOO_TEST_B"));
}

/* A handler and a mask of ours are not the child's. What whoever started this test ignores (a shell in the background
 * SIGINT and SIGQUIT) is not ours. Signals 32 and 33 are the C library's own: what make starts ignores either, and nobody
 * can change that. */
static void nothing(int number)
{
    (void)number;
}

static void signals_have_their_defaults(void **state)
{
    (void)state;
    sigset_t all, before;
    for (int number = 1; number < NSIG; number++) {
        /* The thread sanitizer does not know what was ignored before it began: only handlers are left alone. */
        struct sigaction is;
        if (sigaction(number, NULL, &is) == 0 && (is.sa_handler == SIG_IGN || is.sa_handler == SIG_DFL))
            signal(number, SIG_DFL);
    }
    signal(SIGTERM, nothing);
    signal(SIGPIPE, SIG_IGN);
    sigfillset(&all);
    sigprocmask(SIG_SETMASK, &all, &before);
    int how = run((struct child_options){
        .argv = SH("grep -q 'SigBlk:.*0000000000000000' /proc/self/status && "
                   "grep -qE 'SigIgn:.*0000000(0|1)(0|8)0000000$' /proc/self/status && "
                   "kill -TERM $$; exit 3")});
    sigprocmask(SIG_SETMASK, &before, NULL);
    signal(SIGTERM, SIG_DFL);
    signal(SIGPIPE, SIG_DFL);
    assert_true(WIFSIGNALED(how) && WTERMSIG(how) == SIGTERM);
}

static void waits_end_in_time(void **state)
{
    (void)state;
    struct child child[3] = {{0}};
    int how;
    const double begin = clock_seconds();
    assert_int_equal(child_start(&(struct child_options){.argv = SH("sleep 100")}, &child[0]), OK);
    assert_int_equal(child_start(&(struct child_options){.argv = SH("sleep 0.2; exit 5")}, &child[2]), OK);
    assert_int_equal(child_wait(child, 3, 0, &how), 3);
    assert_int_equal(child_wait(child, 3, 30, &how), 2);
    assert_int_equal(WEXITSTATUS(how), 5);
    assert_int_equal(child_wait(child, 3, 0.2, &how), 3);
    assert_true(clock_seconds() - begin < 20);
    pid_t pid = child[0].pid;
    child_kill(&child[0]);
    child_kill(&child[0]);
    assert_int_equal(kill(pid, 0), -1);
}

static void answers_are_heard(void **state)
{
    (void)state;
    struct text out = {0};
    char said[512];
    int code;
    assert_int_equal(child_ask(SH("seq 100000; seq 1000 >&2; exit 9"), 60, &out, said, &code), OK);
    assert_int_equal(code, 9);
    assert_int_equal(out.size, 588895);
    assert_int_equal(strlen(said), 500);
    assert_string_equal(said + 494, " 1000 ");
    text_free(&out);
}

static void an_answer_that_never_comes_is_an_error(void **state)
{
    (void)state;
    struct text out = {0};
    char said[512];
    int code;
    const double begin = clock_seconds();
    assert_int_equal(child_ask(SH("sleep 100"), 0.3, &out, said, &code), E_INPUT);
    assert_non_null(strstr(status_message(), "no answer within 0.3 s"));
    /* It closes what we listen to, and stays. */
    assert_int_equal(child_ask(SH("exec >/dev/null 2>&1; sleep 100"), 0.3, &out, said, &code), E_INPUT);
    assert_true(clock_seconds() - begin < 20);
    text_free(&out);
}

static bool alive(pid_t pid)
{
    char path[64], text[256] = {0};
    snprintf(path, sizeof path, "/proc/%d/stat", pid);
    FILE *file = fopen(path, "r");
    bool read = file && fgets(text, sizeof text, file);
    if (file)
        fclose(file);
    const char *after = strrchr(text, ')');
    return read && after && after[2] != 'Z';
}

/* Nobody waits any more for what a killed process has begun. */
static void children_die_with_us(void **state)
{
    (void)state;
    int end[2], how;
    struct child child = {0};
    assert_int_equal(pipe(end), 0);
    pid_t middle = fork();
    if (middle == 0) {
        if (child_start(&(struct child_options){.argv = SH("exec sleep 100")}, &child) != OK ||
            write(end[1], &child.pid, sizeof child.pid) != sizeof child.pid)
            _exit(1);
        pause();
        _exit(0);
    }
    pid_t inner = 0;
    assert_int_equal(read(end[0], &inner, sizeof inner), sizeof inner);
    assert_true(alive(inner));
    kill(middle, SIGKILL);
    assert_int_equal(waitpid(middle, &how, 0), middle);
    for (int i = 0; i < 500 && alive(inner); i++)
        usleep(10000);
    assert_false(alive(inner));
    close(end[0]);
    close(end[1]);
}

static status count(void *user)
{
    ++*(int *)user;
    return OK;
}

static void groups_run_side_by_side(void **state)
{
    (void)state;
    struct children c;
    int done = 0;
    children_begin(&c, ".", "group.log", "sand", 4);
    for (int i = 0; i < 8; i++)
        assert_int_equal(children_run(&c,
                                      SH("mkdir here.$$; for i in $(seq 600); do set -- here.*; "
                                         "[ $# -ge 4 ] && exit 0; sleep 0.1; done; exit 1"),
                                      "a wait for three others", count, &done),
                         OK);
    assert_int_equal(children_wait(&c), OK);
    assert_int_equal(done, 8);
    assert_int_equal(children_run(&c, SH("echo oh; exit 3"), "a cake", count, &done), OK);
    assert_int_equal(children_wait(&c), E_OUTPUT);
    assert_string_equal(status_message(),
                        "a cake could not be made (exit 3); see the program's output in ./group.log");
    assert_int_equal(
        children_run(&c, (const char *const[]){"no-such-program", NULL}, "a castle", count, &done), OK);
    assert_int_equal(children_wait(&c), E_INPUT);
    assert_string_equal(status_message(), "a castle: a program is missing; install sand");
    assert_int_equal(children_run(&c, SH("sleep 100"), "a night", count, &done), OK);
    pid_t pid = c.child[0].pid;
    children_end(&c);
    assert_int_equal(kill(pid, 0), -1);
    assert_int_equal(done, 8);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(ends_are_told),
        cmocka_unit_test(logs_grow_and_their_last_words_are_the_reason),
        cmocka_unit_test(descriptors_are_passed),
        cmocka_unit_test(variables_do_not_replace_the_users),
        cmocka_unit_test(signals_have_their_defaults),
        cmocka_unit_test(waits_end_in_time),
        cmocka_unit_test(answers_are_heard),
        cmocka_unit_test(an_answer_that_never_comes_is_an_error),
        cmocka_unit_test(children_die_with_us),
        cmocka_unit_test(groups_run_side_by_side),
    };
    cmocka_set_message_output(CM_OUTPUT_TAP);
    return cmocka_run_group_tests(tests, NULL, NULL);
}
