/* Readers of files: whatever one does, who asked gets an answer, and it can do nothing but read. This program is its own
 * reader, which does what the file's name says. */
#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/ptrace.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/clock.h"
#include "effort.h"
#include "image/image.h"
#include "image/protocol.h"
#include "reader/reader.h"
#include "reader/serve.h"

enum { SIDE = 1000 };

/* ---- in the reader */

/* What no reader may do, each 1 if it was refused. */
static size_t try_to_escape(const char *path, float *refused)
{
    const char *const argv[] = {"/bin/true", NULL};
    size_t n = 0;
#define REFUSED(call) refused[n++] = (call) == -1 && errno == EPERM
    REFUSED(open("written", O_WRONLY | O_CREAT, 0666));
    REFUSED(open(path, O_RDWR));
    REFUSED(open(path, O_RDONLY | O_TRUNC));
    REFUSED(openat(AT_FDCWD, path, O_WRONLY | O_APPEND));
    REFUSED(unlink(path));
    REFUSED(rename(path, "renamed"));
    REFUSED(chmod(path, 0777));
    REFUSED(socket(AF_INET, SOCK_STREAM, 0));
    REFUSED(socket(AF_UNIX, SOCK_STREAM, 0));
    REFUSED(fork());
    REFUSED(execv(argv[0], (char *const *)argv));
    REFUSED(kill(getppid(), SIGKILL));
    REFUSED(ptrace(PTRACE_ATTACH, getppid(), NULL, NULL));
    REFUSED(chdir("/"));
    refused[n++] = mmap(NULL, 4096, PROT_READ | PROT_EXEC, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0) == MAP_FAILED;
    int fd = open(path, O_RDONLY | O_CLOEXEC);
    char byte;
    refused[n++] = fd > 0 && read(fd, &byte, 1) == 1;
    return n;
}

static status put_image(struct serve_answer *a, uint64_t width, uint64_t height, const float *value, size_t n)
{
    status st = OK;
    const struct image_answer part = {.width = width, .height = height};
    TRY(serve_add_part(a, &part, sizeof part));
    TRY(serve_begin_part(a)); /* nothing to say */
    TRY(serve_add_part(a, value, n * sizeof *value));
done:
    return st;
}

static status misbehave(const struct serve_question *q, struct serve_answer *a)
{
    static float value[SIDE * SIDE];
    const char *what = strrchr(q->path, '/') ? strrchr(q->path, '/') + 1 : q->path;
    for (int i = 0; i < SIDE * SIDE; i++)
        value[i] = (float)i;
    if (strcmp(what, "crash") == 0) {
        signal(SIGSEGV, SIG_DFL); /* sanitizers catch it */
        raise(SIGSEGV);
    } else if (strcmp(what, "abort") == 0) {
        signal(SIGABRT, SIG_DFL);
        abort();
    } else if (strcmp(what, "slow") == 0) {
        raise(SIGXCPU);
    } else if (strcmp(what, "hung") == 0) {
        for (;;)
            sleep(1);
    } else if (strcmp(what, "silent") == 0) {
        _exit(0);
    } else if (strcmp(what, "babbling") == 0) {
        _exit(pwrite(READER_ANSWER_FD, value, sizeof value, 0) > 0 ? 0 : 1);
    } else if (strcmp(what, "absurd") == 0) {
        return put_image(a, IMAGE_MAX_PIXELS, 1000, value, 10);
    } else if (strcmp(what, "overflowing") == 0) {
        return put_image(a, UINT64_MAX / 2 + 1, 2, value, 10);
    } else if (strcmp(what, "short") == 0) {
        return put_image(a, 20, 20, value, 399);
    } else if (strcmp(what, "long") == 0) {
        return put_image(a, 20, 20, value, 401);
    } else if (strcmp(what, "liar") == 0) {
        a->head.n_parts = 2;
        a->head.size[0] = sizeof(struct image_answer);
        a->head.size[1] = UINT64_MAX - 8;
        return OK;
    } else if (strcmp(what, "crowd") == 0) {
        a->head.n_parts = 1u << 30;
        return OK;
    } else if (strcmp(what, "strange") == 0) {
        return (status)77;
    } else if (strcmp(what, "rude") == 0) {
        return fail(E_INPUT, "%s: \xff\xfe is no text", q->path);
    } else if (strcmp(what, "greedy") == 0) {
        char *much = malloc((size_t)6 << 30);
        if (!much)
            return fail(E_MEMORY, "none");
        free(much);
    } else if (strcmp(what, "chatty") == 0) {
        for (int i = 0; i < 100000; i++)
            fprintf(stderr, "ok 99 - not for the log\n");
    } else if (strcmp(what, "prison") == 0) {
        size_t n = try_to_escape(q->path, value);
        return put_image(a, n, 1, value, n);
    }
    return put_image(a, SIDE, SIDE, value, SIDE * SIDE);
}

static int be_the_reader(int argc, char **argv)
{
    static const struct serve_kind kinds[] = {{"image", (uint64_t)4 << 30, misbehave}};
    return serve(argc, argv, kinds, 1);
}

#include "scene_help.h" /* after the use of fail() */

/* ---- who asks */

static status read_named(const char *name)
{
    struct image image;
    status st = image_read(&(struct image_request){.file = write_text(name, "x"), .scale = 1}, &image);
    if (st != OK)
        assert_null(image.value);
    image_free(&image);
    return st;
}

static void a_reader_that_fails_is_an_error(void **state)
{
    (void)state;
    static const char *const expected[][2] = {{"crash", "crashed: Segmentation fault"},
                                              {"abort", "crashed: Aborted"},
                                              {"slow", "too long"},
                                              {"silent", "without an answer"},
                                              {"babbling", "without an answer"},
                                              {"absurd", "is malformed"},
                                              {"overflowing", "is malformed"},
                                              {"short", "is malformed"},
                                              {"long", "is malformed"},
                                              {"liar", "is malformed"},
                                              {"crowd", "is malformed"},
                                              {"strange", "is malformed"},
                                              {"rude", "?? is no text"}};
    for (size_t i = 0; i < sizeof expected / sizeof *expected; i++)
        assert_failed(read_named(expected[i][0]), E_INPUT, expected[i][0], expected[i][1]);
}

static void one_that_never_ends_is_ended(void **state)
{
    (void)state;
    struct reader_answer answer;
    const double begin = clock_seconds();
    const struct reader_question question = {
        .program = "hoodoo-read-image", .kind = "image", .path = write_text("hung", "x"), .seconds = 0.5};
    assert_failed(reader_ask(&question, &answer), E_INPUT, "hung", "too long");
    assert_true(clock_seconds() - begin < 30);
}

static void a_greedy_one_gets_no_memory(void **state)
{
    (void)state;
    if (SANITIZED) {
        print_message("# skipped: no limit below the address space that the sanitizer has reserved\n");
        skip();
    }
    assert_failed(read_named("greedy"), E_INPUT, "greedy", "more memory than a file of this size should");
}

static void large_answers_arrive_whole(void **state)
{
    (void)state;
    struct image image;
    assert_int_equal(image_read(&(struct image_request){.file = write_text("chatty", "x")}, &image), OK);
    assert_true(image.width == SIDE && image.height == SIDE);
    for (int i = 0; i < SIDE * SIDE; i++)
        assert_true(image.value[i] == (float)i);
    image_free(&image);
}

static void it_can_do_nothing_but_read(void **state)
{
    (void)state;
    struct image image;
    assert_int_equal(image_read(&(struct image_request){.file = write_text("prison", "x")}, &image), OK);
    assert_int_equal(image.width, 16);
    for (size_t i = 0; i < image.width; i++)
        if (image.value[i] != 1)
            fail_msg("attempt %zu was not refused", i);
    image_free(&image);
    assert_int_not_equal(access("written", F_OK), 0);
}

static void one_that_is_missing_is_named(void **state)
{
    (void)state;
    char *before = strdup(getenv("HOODOO_LIBEXEC"));
    assert_int_equal(mkdir("empty", 0777), 0);
    setenv("HOODOO_LIBEXEC", "empty", 1);
    assert_failed(read_named("good"), E_INPUT, "hoodoo-read-image", "HOODOO_LIBEXEC");
    FILE *file = fopen("empty/hoodoo-read-image", "w");
    fclose(file);
    assert_failed(read_named("good"), E_INPUT, "hoodoo-read-image", "could not be started");
    setenv("HOODOO_LIBEXEC", before, 1);
    assert_int_equal(read_named("good"), OK);
    free(before);
}

static int play_the_reader(void **state)
{
    char self[4096], folder[4096];
    (void)state;
    ssize_t n = readlink("/proc/self/exe", self, sizeof self - 1);
    if (n <= 0 || mkdir("readers", 0777) != 0 || !realpath("readers", folder))
        return -1;
    self[n] = '\0';
    setenv("HOODOO_LIBEXEC", folder, 1);
    return symlink(self, "readers/hoodoo-read-image");
}

int main(int argc, char **argv)
{
    if (argc > 2)
        return be_the_reader(argc, argv);
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_reader_that_fails_is_an_error), cmocka_unit_test(one_that_never_ends_is_ended),
        cmocka_unit_test(a_greedy_one_gets_no_memory),     cmocka_unit_test(large_answers_arrive_whole),
        cmocka_unit_test(it_can_do_nothing_but_read),      cmocka_unit_test(one_that_is_missing_is_named),
    };
    cmocka_set_message_output(CM_OUTPUT_TAP);
    return cmocka_run_group_tests(tests, play_the_reader, remove_files);
}
