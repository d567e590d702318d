/* The lock: one holder at a time, none for ever. */
#include "check.h"

#include <fcntl.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#include "base/lock.h"

static const struct lock_patience quick = {.beat_s = 0.1, .watch_s = 0.6};

static double seconds_now(void)
{
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

static bool there(const char *path)
{
    return access(path, F_OK) == 0;
}

/* A child that holds the lock until it is killed. */
static pid_t holder(const char *path)
{
    unlink(path); /* of a test that failed */
    pid_t pid = fork();
    if (pid == 0) {
        struct lock *lock;
        if (lock_take(path, "simulates frames 1-9 here", quick, NULL, &lock) != OK)
            _exit(1);
        for (;;)
            pause();
    }
    for (int i = 0; i < 1000 && !there(path); i++)
        usleep(2000);
    return pid;
}

static void end(pid_t pid)
{
    kill(pid, SIGKILL);
    waitpid(pid, NULL, 0);
}

static void a_living_holder_keeps_others_out(void **state)
{
    (void)state;
    struct lock *lock = NULL;
    char number[32];
    pid_t pid = holder("a.lock");
    double start = seconds_now();
    assert_int_equal(lock_take("a.lock", "x", quick, NULL, &lock), E_OUTPUT);
    assert_null(lock);
    snprintf(number, sizeof number, "process %d", (int)pid);
    assert_non_null(strstr(status_message(), number));
    assert_non_null(strstr(status_message(), "simulates frames 1-9 here"));
    assert_true(seconds_now() - start < 0.3); /* known at once on one machine */
    end(pid);
}

static void a_killed_holders_lock_is_taken_over_at_once(void **state)
{
    (void)state;
    struct lock *lock = NULL;
    end(holder("b.lock"));
    assert_true(there("b.lock"));
    double start = seconds_now();
    assert_ok(lock_take("b.lock", "x", quick, NULL, &lock));
    assert_true(seconds_now() - start < 0.3);
    assert_ok(lock_check(lock));
    lock_release(&lock);
    assert_false(there("b.lock"));
}

static void write_lock(const char *path, const char *host, int count, const char *token)
{
    FILE *f = fopen("new", "w");
    assert_non_null(f);
    fprintf(f,
            "%012d\n{\"token\": \"%s\", \"host\": \"%s\", \"boot\": \"b\", \"pid_space\": \"p\", \"pid\": 1, "
            "\"began\": 1, "
            "\"since\": \"then\", \"what\": \"writes\"}\n",
            count, token, host);
    fclose(f);
    assert_int_equal(rename("new", path), 0);
}

static void a_lock_from_elsewhere_is_watched(void **state)
{
    (void)state;
    struct lock *lock = NULL;
    write_lock("c.lock", "elsewhere", 7, "t");
    double start = seconds_now();
    assert_ok(lock_take("c.lock", "x", quick, NULL, &lock));
    double took = seconds_now() - start;
    assert_true(took >= 0.5 && took < 3);
    lock_release(&lock);

    pid_t pid = fork();
    if (pid == 0)
        for (int i = 0;; i++) {
            write_lock("c.lock", "elsewhere", i, "t");
            usleep(100000);
        }
    while (!there("c.lock"))
        usleep(1000);
    assert_int_equal(lock_take("c.lock", "x", quick, NULL, &lock), E_OUTPUT);
    assert_non_null(strstr(status_message(), "elsewhere"));
    end(pid);
    unlink("c.lock");
}

static bool always(void)
{
    return true;
}

static void waiting_for_another_machine_can_be_stopped(void **state)
{
    (void)state;
    struct lock *lock = NULL;
    write_lock("d.lock", "elsewhere", 7, "t");
    assert_int_equal(lock_take("d.lock", "x", quick, always, &lock), STOPPED);
    assert_true(there("d.lock"));
    unlink("d.lock");
}

static void files_that_are_no_locks_do_not_hold_for_ever(void **state)
{
    (void)state;
    const char *const bad[] = {"", "x", "000000000001\n{",
                               "000000000001\n{\"host\": \"a\\nb\", \"pid\": -5, \"token\": 4}"};
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        struct lock *lock = NULL;
        FILE *f = fopen("e.lock", "w");
        assert_non_null(f);
        fputs(bad[i], f);
        fclose(f);
        assert_ok(lock_take("e.lock", "x", quick, NULL, &lock));
        lock_release(&lock);
    }
    struct lock *lock = NULL;
    assert_int_equal(symlink("nowhere", "e.lock"), 0);
    assert_ok(lock_take("e.lock", "x", quick, NULL, &lock));
    lock_release(&lock);
    assert_int_equal(lock_take("no/such/folder/lock", "x", quick, NULL, &lock), E_OUTPUT);
}

static void a_lock_that_was_taken_away_is_noticed(void **state)
{
    (void)state;
    struct lock *lock = NULL;
    assert_ok(lock_take("f.lock", "x", quick, NULL, &lock));
    usleep(300000);
    assert_ok(lock_check(lock));
    write_lock("f.lock", "elsewhere", 1, "another");
    usleep(400000);
    assert_int_equal(lock_check(lock), E_OUTPUT);
    lock_release(&lock);
    assert_true(there("f.lock")); /* it is the other one's */
    unlink("f.lock");
}

/* Many at once on a lock that was left behind, again and again: never two inside. */
static void only_one_is_inside(void **state)
{
    (void)state;
    enum { PROCESSES = 6, TURNS = 25 };
    int bad = 0, how;
    end(holder("g.lock"));
    unlink("inside");
    for (int p = 0; p < PROCESSES; p++)
        if (fork() == 0) {
            if (!freopen("/dev/null", "w", stderr))
                _exit(2);
            for (int turn = 0; turn < TURNS;) {
                struct lock *lock;
                if (lock_take("g.lock", "x", quick, NULL, &lock) != OK) {
                    usleep(500);
                    continue;
                }
                int fd = open("inside", O_CREAT | O_EXCL, 0600);
                if (fd < 0)
                    _exit(1);
                close(fd);
                usleep(300);
                unlink("inside");
                turn++;
                if (turn % 9 == 0 && p % 2)
                    _exit(0); /* as if killed: the lock stays behind */
                lock_release(&lock);
            }
            _exit(0);
        }
    for (int p = 0; p < PROCESSES; p++) {
        assert_true(wait(&how) > 0);
        bad += !WIFEXITED(how) || WEXITSTATUS(how) != 0;
    }
    assert_int_equal(bad, 0);
    unlink("g.lock");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_living_holder_keeps_others_out),
        cmocka_unit_test(a_killed_holders_lock_is_taken_over_at_once),
        cmocka_unit_test(a_lock_from_elsewhere_is_watched),
        cmocka_unit_test(waiting_for_another_machine_can_be_stopped),
        cmocka_unit_test(files_that_are_no_locks_do_not_hold_for_ever),
        cmocka_unit_test(a_lock_that_was_taken_away_is_noticed),
        cmocka_unit_test(only_one_is_inside),
    };
    return cmocka_run_group_tests_name("lock", tests, NULL, NULL);
}
