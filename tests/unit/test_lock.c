/* The lock: one holder at a time, none for ever. */
#include "check.h"

#include <errno.h>
#include <fcntl.h>
#include <sched.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/mount.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#include "base/clock.h"
#include "system/atomic_file.h"
#include "system/lock.h"
#include "system/process.h"

/* For all of this program: the wall clock is as many seconds ahead, the machine slept as long, and the disk has no hard links, for this
 * reason. */
static _Atomic time_t ahead_s, slept_s;
static int no_links;

int clock_gettime(clockid_t clock, struct timespec *out)
{
    const int code = (int)syscall(SYS_clock_gettime, clock, out);
    if (clock == CLOCK_REALTIME && code == 0)
        out->tv_sec += ahead_s;
    if (clock == CLOCK_BOOTTIME && code == 0)
        out->tv_sec += slept_s;
    return code;
}

time_t time(time_t *out)
{
    struct timespec now;
    clock_gettime(CLOCK_REALTIME, &now);
    if (out)
        *out = now.tv_sec;
    return now.tv_sec;
}

int link(const char *from, const char *to)
{
    errno = no_links;
    return no_links ? -1 : (int)syscall(SYS_link, from, to);
}

static const struct lock_patience quick = {.heartbeat_s = 0.1, .watch_s = 0.6};

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
    double start = clock_seconds();
    assert_int_equal(lock_take("a.lock", "x", quick, NULL, &lock), E_OUTPUT);
    assert_null(lock);
    snprintf(number, sizeof number, "process %d", (int)pid);
    assert_non_null(strstr(status_message(), number));
    assert_non_null(strstr(status_message(), "simulates frames 1-9 here"));
    assert_true(clock_seconds() - start < 0.3); /* known at once on one machine */
    end(pid);
}

static void a_killed_holders_lock_is_taken_over_at_once(void **state)
{
    (void)state;
    struct lock *lock = NULL;
    end(holder("b.lock"));
    assert_true(there("b.lock"));
    double start = clock_seconds();
    assert_ok(lock_take("b.lock", "x", quick, NULL, &lock));
    assert_true(clock_seconds() - start < 0.3);
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
    double start = clock_seconds();
    assert_ok(lock_take("c.lock", "x", quick, NULL, &lock));
    double took = clock_seconds() - start;
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

static long long count_in(const char *path)
{
    long long count = -1;
    FILE *f = fopen(path, "r");
    assert_non_null(f);
    assert_int_equal(fscanf(f, "%lld", &count), 1);
    fclose(f);
    return count;
}

static void a_clock_that_is_set_back_does_not_stop_the_beat(void **state)
{
    (void)state;
    struct lock *lock = NULL;
    ahead_s = 3600;
    assert_ok(lock_take("h.lock", "x", quick, NULL, &lock));
    usleep(250000);
    ahead_s = 0;
    usleep(250000); /* the beat that was waited for when the clock was set has come by now */
    const long long before = count_in("h.lock");
    usleep(500000);
    assert_true(count_in("h.lock") > before);
    lock_release(&lock);
}

/* The beat cannot read its own lock once, as from a disk that errs: that is no other holder. */
static void a_lock_that_cannot_be_read_for_a_moment_is_not_lost(void **state)
{
    (void)state;
    struct lock *lock = NULL;
    assert_ok(lock_take("i.lock", "x", quick, NULL, &lock));
    assert_int_equal(mkdir("i.folder", 0700), 0);
    assert_int_equal(renameat2(AT_FDCWD, "i.lock", AT_FDCWD, "i.folder", RENAME_EXCHANGE), 0);
    usleep(300000);
    assert_int_equal(renameat2(AT_FDCWD, "i.lock", AT_FDCWD, "i.folder", RENAME_EXCHANGE), 0);
    assert_int_equal(rmdir("i.folder"), 0);
    usleep(300000);
    assert_ok(lock_check(lock));
    lock_release(&lock);
    assert_false(there("i.lock"));
}

/* In a child: an ordinary user, to whom /proc shows no process of others. 77: this machine does not allow it. */
static int as_a_stranger(const struct process_id *other, long holder_pid)
{
    struct lock *lock;
    char number[40];
    if (chdir("hidden") != 0 || unshare(CLONE_NEWNS) != 0 ||
        mount(NULL, "/", NULL, MS_REC | MS_PRIVATE, NULL) != 0 ||
        mount("proc", "/proc", "proc", 0, "hidepid=2") != 0 || setresgid(65534, 65534, 65534) != 0 ||
        setresuid(65534, 65534, 65534) != 0)
        return 77;
    if (process_fate(other) != PROCESS_UNKNOWN)
        return 1;
    snprintf(number, sizeof number, "lock: process %ld on ", holder_pid);
    return lock_take("lock", "x", quick, NULL, &lock) == E_OUTPUT && strstr(status_message(), number) ? 0 : 2;
}

static void a_living_holder_that_proc_hides_keeps_others_out(void **state)
{
    (void)state;
    int how;
    struct process_id me;
    process_self(&me);
    assert_int_equal(process_fate(&me), PROCESS_LIVES);
    assert_int_equal(mkdir("hidden", 0777), 0);
    assert_int_equal(chmod("hidden", 0777), 0);
    pid_t pid = holder("hidden/lock");
    pid_t stranger = fork();
    if (stranger == 0)
        _exit(as_a_stranger(&me, pid));
    assert_int_equal(waitpid(stranger, &how, 0), stranger);
    end(pid);
    unlink("hidden/lock");
    assert_true(WIFEXITED(how));
    if (WEXITSTATUS(how) == 77)
        skip();
    assert_int_equal(WEXITSTATUS(how), 0);
}

static void the_fate_of_processes(void **state)
{
    (void)state;
    struct process_id me, other;
    process_self(&me);
    assert_true(me.began > 0);
    other = me;
    other.began++; /* its number came again */
    assert_int_equal(process_fate(&other), PROCESS_GONE);
    other = me;
    other.host[0] ^= 1;
    assert_int_equal(process_fate(&other), PROCESS_UNKNOWN);
    other = me;
    other.space[0] ^= 1;
    assert_int_equal(process_fate(&other), PROCESS_UNKNOWN);
    pid_t pid = fork();
    if (pid == 0)
        _exit(0);
    waitpid(pid, NULL, 0);
    other = me;
    other.pid = pid;
    assert_int_equal(process_fate(&other), PROCESS_GONE);
}

static void make(const char *path)
{
    FILE *f = fopen(path, "w");
    assert_non_null(f);
    fclose(f);
}

/* A process that was suspended, with all its threads, writes nothing once another has its folder: not even the first file after it wakes,
 * before its heartbeat. */
static status check_lock(void *lock)
{
    return lock_check(lock);
}

static void a_late_holder_renames_nothing(void **state)
{
    (void)state;
    struct lock *lock = NULL;
    const struct lock_patience slow = {.heartbeat_s = 3};
    assert_ok(lock_take("j.lock", "x", slow, NULL, &lock));
    atomic_file_guard(check_lock, lock);
    assert_ok(atomic_file_write("j.file", "old", 3));
    /* In time it does not read the file; late it does. */
    write_lock("j.lock", "elsewhere", 1, "another");
    assert_ok(atomic_file_write("j.file", "own", 3));
    slept_s = 60;
    assert_int_equal(atomic_file_write("j.file", "new", 3), E_OUTPUT);
    assert_non_null(strstr(status_message(), "another process took over"));
    slept_s = 0;
    atomic_file_guard(NULL, NULL);
    FILE *f = fopen("j.file", "r");
    char text[4] = "";
    assert_non_null(f);
    assert_non_null(fgets(text, sizeof text, f));
    fclose(f);
    assert_string_equal(text, "own");
    lock_release(&lock);
    unlink("j.lock");
    /* Late, but still the holder. */
    assert_ok(lock_take("j.lock", "x", slow, NULL, &lock));
    slept_s = 60;
    assert_ok(lock_check(lock));
    unlink("j.lock");
    assert_int_equal(mkdir("j.lock", 0700), 0);
    slept_s = 120;
    assert_int_equal(lock_check(lock), E_OUTPUT);
    slept_s = 0;
    rmdir("j.lock");
    lock_release(&lock);
}

/* Disks without hard links, in the whole of what the tests above try. */
static void without_links(void **state)
{
    static void (*const cases[])(void **) = {
        a_living_holder_keeps_others_out, a_killed_holders_lock_is_taken_over_at_once,
        a_lock_from_elsewhere_is_watched, files_that_are_no_locks_do_not_hold_for_ever};
    static const int reasons[] = {EPERM, EOPNOTSUPP};
    for (size_t r = 0; r < 2; r++)
        for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
            no_links = reasons[r];
            cases[i](state);
        }
    no_links = 0;
}

/* Two containers of one machine share a folder; in the one that sweeps, the other's process numbers mean nothing. */
static void temporaries_of_another_container_are_not_swept(void **state)
{
    (void)state;
    struct path ours;
    int how;
    assert_int_equal(mkdir("swept", 0777), 0);
    assert_ok(atomic_file_temporary("swept/a", "", &ours));
    make(ours.text);
    pid_t pid = fork();
    if (pid == 0) {
        if (unshare(CLONE_NEWPID) != 0)
            _exit(77);
        pid_t inner = fork();
        if (inner == 0) {
            atomic_file_sweep("swept");
            _exit(there(ours.text) ? 0 : 1);
        }
        _exit(waitpid(inner, &how, 0) == inner && WIFEXITED(how) ? WEXITSTATUS(how) : 2);
    }
    assert_int_equal(waitpid(pid, &how, 0), pid);
    assert_true(WIFEXITED(how));
    unlink(ours.text);
    if (WEXITSTATUS(how) == 77)
        skip();
    assert_int_equal(WEXITSTATUS(how), 0);
}

/* Files are as old as the disk says: a machine whose clock is days ahead takes those of living processes elsewhere for new. */
static void a_clock_that_is_ahead_sweeps_nothing(void **state)
{
    (void)state;
    static const char theirs[] = "ahead/a.tmp-00000001-1-1-0";
    const struct timespec long_ago[2] = {{1000000000, 0}, {1000000000, 0}};
    assert_int_equal(mkdir("ahead", 0777), 0);
    make(theirs);
    ahead_s = 3 * 86400;
    atomic_file_sweep("ahead");
    ahead_s = 0;
    assert_true(there(theirs));
    assert_int_equal(utimensat(AT_FDCWD, theirs, long_ago, 0), 0);
    atomic_file_sweep("ahead");
    assert_false(there(theirs));
    assert_int_equal(rmdir("ahead"), 0); /* nothing else was left there */
}

static void temporaries_of_killed_processes_are_swept(void **state)
{
    (void)state;
    struct path *theirs =
        mmap(NULL, sizeof *theirs, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
    assert_ptr_not_equal(theirs, MAP_FAILED);
    assert_int_equal(mkdir("dead", 0777), 0);
    pid_t pid = fork();
    if (pid == 0) {
        if (atomic_file_temporary("dead/a", "", theirs) != OK)
            _exit(1);
        make(theirs->text);
        for (;;)
            pause();
    }
    for (int i = 0; i < 1000 && !(*theirs->text && there(theirs->text)); i++)
        usleep(2000);
    assert_true(there(theirs->text));
    atomic_file_sweep("dead");
    assert_true(there(theirs->text)); /* it lives */
    end(pid);
    atomic_file_sweep("dead");
    assert_false(there(theirs->text));
    munmap(theirs, sizeof *theirs);
}

static void race(void);

static void only_one_is_inside(void **state)
{
    (void)state;
    race();
}

static void only_one_is_inside_without_links(void **state)
{
    (void)state;
    no_links = EPERM;
    race();
    no_links = 0;
}

/* Many at once on a lock that was left behind, again and again: never two inside. */
static void race(void)
{
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
        cmocka_unit_test(a_clock_that_is_set_back_does_not_stop_the_beat),
        cmocka_unit_test(a_lock_that_cannot_be_read_for_a_moment_is_not_lost),
        cmocka_unit_test(a_living_holder_that_proc_hides_keeps_others_out),
        cmocka_unit_test(the_fate_of_processes),
        cmocka_unit_test(temporaries_of_another_container_are_not_swept),
        cmocka_unit_test(temporaries_of_killed_processes_are_swept),
        cmocka_unit_test(only_one_is_inside),
        cmocka_unit_test(only_one_is_inside_without_links),
        cmocka_unit_test(a_late_holder_renames_nothing),
        cmocka_unit_test(without_links),
        cmocka_unit_test(a_clock_that_is_ahead_sweeps_nothing),
    };
    return cmocka_run_group_tests_name("lock", tests, NULL, NULL);
}
