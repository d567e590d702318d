/* The output of a child, and the reason of its failure. */
#include <errno.h>
#include <fcntl.h>
#include <poll.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include "base/clock.h"
#include "system/child.h"

enum { TAIL = 4000, ANSWER_MAX = 16 << 20 };

/* The last message of hoodoo in a log. */
static void last_message(const char *log, char *out, size_t size)
{
    char tail[TAIL + 1];
    out[0] = '\0';
    int fd = open(log, O_RDONLY | O_CLOEXEC);
    struct stat info;
    if (fd < 0 || fstat(fd, &info) != 0) {
        if (fd >= 0)
            close(fd);
        return;
    }
    ssize_t n = pread(fd, tail, TAIL, info.st_size > TAIL ? info.st_size - TAIL : 0);
    close(fd);
    tail[n > 0 ? n : 0] = '\0';
    for (char *line = tail; line;) {
        char *next = strchr(line, '\n');
        if (next)
            *next++ = '\0';
        if (strncmp(line, "hoodoo: ", 8) == 0)
            snprintf(out, size, "%s", line + 8);
        line = next;
    }
}

void child_reason(int how, const char *log, char *out, size_t size)
{
    char message[500];
    last_message(log, message, sizeof message);
    if (WIFEXITED(how))
        snprintf(out, size, "exit %d: %s", WEXITSTATUS(how), message);
    else
        snprintf(out, size, "killed by signal %d (%s)", WTERMSIG(how), strsignal(WTERMSIG(how)));
}

/* Appends bytes to `errors`, which keeps the last 500. */
static void keep_end(char errors[512], const char *bytes, size_t n)
{
    size_t have = strlen(errors), add = n < 500 ? n : 500;
    if (have + add > 500) {
        size_t drop = have + add - 500;
        memmove(errors, errors + drop, have - drop);
        have -= drop;
    }
    memcpy(errors + have, bytes + n - add, add);
    errors[have + add] = '\0';
}

/* Reads the available bytes; false at the end. */
static bool drain(int fd, struct text *out, char *errors)
{
    char bytes[4096];
    ssize_t n = read(fd, bytes, sizeof bytes);
    if (n > 0 && out && out->size < ANSWER_MAX)
        text_add_bytes(out, bytes, (size_t)n);
    else if (n > 0 && errors)
        keep_end(errors, bytes, (size_t)n);
    return n > 0 || (n < 0 && errno == EINTR);
}

/* Reads both pipes until they are closed; false if the time `until` passes before. */
static bool listen_to(const int end[2], struct text *out, char errors[512], double until)
{
    bool open[2] = {true, true};
    while (open[0] || open[1]) {
        struct pollfd wait[2] = {{.fd = open[0] ? end[0] : -1, .events = POLLIN},
                                 {.fd = open[1] ? end[1] : -1, .events = POLLIN}};
        double left = until - clock_seconds();
        if (left <= 0)
            return false;
        if (poll(wait, 2, (int)(left * 1000) + 1) <= 0)
            continue;
        if (wait[0].revents)
            open[0] = drain(end[0], out, NULL);
        if (wait[1].revents)
            open[1] = drain(end[1], NULL, errors);
    }
    return true;
}

status child_ask(const char *const *argv, double seconds, struct text *out, char errors[512], int *code)
{
    int out_pipe[2], err_pipe[2], how = 0;
    struct child child = {0};
    const double until = clock_seconds() + seconds;
    errors[0] = '\0';
    if (pipe2(out_pipe, O_CLOEXEC) != 0)
        return fail(E_MEMORY, "%s: no pipe: %s", argv[0], strerror(errno));
    if (pipe2(err_pipe, O_CLOEXEC) != 0) {
        close(out_pipe[0]);
        close(out_pipe[1]);
        return fail(E_MEMORY, "%s: no pipe: %s", argv[0], strerror(errno));
    }
    status st =
        child_start(&(struct child_options){.argv = argv, .out = out_pipe[1], .err = err_pipe[1]}, &child);
    close(out_pipe[1]);
    close(err_pipe[1]);
    bool in_time = st == OK && listen_to((const int[]){out_pipe[0], err_pipe[0]}, out, errors, until);
    close(out_pipe[0]);
    close(err_pipe[0]);
    while (in_time && child.pid && clock_seconds() < until)
        child_wait(&child, 1, until - clock_seconds(), &how);
    if (child.pid) {
        child_kill(&child);
        return fail(E_INPUT, "%s: no answer within %g s", argv[0], seconds);
    }
    if (st != OK)
        return st;
    *code = WIFEXITED(how) ? WEXITSTATUS(how) : 128 + WTERMSIG(how);
    for (char *s = errors; *s; s++)
        if ((unsigned char)*s < 0x20)
            *s = ' ';
    return text_status(out);
}
