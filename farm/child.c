#include "farm/child.h"

#include <errno.h>
#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/prctl.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

enum { NOT_FOUND = 127, TAIL = 4000, ANSWER_MAX = 16 << 20 };

static void default_signals(void)
{
    static const int numbers[] = {SIGTERM, SIGINT, SIGUSR1, SIGPIPE};
    for (size_t i = 0; i < sizeof numbers / sizeof *numbers; i++)
        signal(numbers[i], SIG_DFL);
}

static void become(const char *const *argv, const char *log, const struct child_variable *variable,
                   size_t n_variables, pid_t parent)
{
    default_signals();
    int in = open("/dev/null", O_RDONLY), out = open(log, O_WRONLY | O_CREAT | O_APPEND, 0666);
    if (in < 0 || out < 0 || dup2(in, 0) < 0 || dup2(out, 1) < 0 || dup2(out, 2) < 0)
        _exit(NOT_FOUND - 1);
    setpgid(0, 0);
    prctl(PR_SET_PDEATHSIG, SIGTERM);
    if (getppid() != parent)
        _exit(NOT_FOUND - 1);
    for (size_t i = 0; i < n_variables; i++)
        if (variable[i].name)
            setenv(variable[i].name, variable[i].value, 0);
    execvp(argv[0], (char *const *)argv);
    _exit(NOT_FOUND);
}

status child_start(const char *const *argv, const char *log, const struct child_variable *variable,
                   size_t n_variables, pid_t *out)
{
    fflush(NULL);
    pid_t parent = getpid(), pid = fork();
    if (pid < 0)
        return fail(E_MEMORY, "%s: no new process: %s", argv[0], strerror(errno));
    if (pid == 0)
        become(argv, log, variable, n_variables, parent);
    *out = pid;
    return OK;
}

/* The last line that hoodoo said, from the end of a log. */
static void last_words(const char *log, char *out, size_t size)
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
    char words[500];
    last_words(log, words, sizeof words);
    if (WIFEXITED(how))
        snprintf(out, size, "exit %d: %s", WEXITSTATUS(how), words);
    else
        snprintf(out, size, "killed by signal %d (%s)", WTERMSIG(how), strsignal(WTERMSIG(how)));
}

/* ---- questions */

static void drain(int fd, struct text *out, char said[512], bool *open)
{
    char bytes[4096];
    ssize_t n = read(fd, bytes, sizeof bytes);
    if (n < 0 && errno == EINTR)
        return;
    *open = n > 0;
    if (n > 0 && out && out->size < ANSWER_MAX) {
        text_add_bytes(out, bytes, (size_t)n);
    } else if (n > 0 && said) {
        size_t have = strlen(said), add = (size_t)n < 500 ? (size_t)n : 500;
        if (have + add > 500) {
            size_t drop = have + add - 500;
            memmove(said, said + drop, have - drop);
            have -= drop;
        }
        memcpy(said + have, bytes + (size_t)n - add, add);
        said[have + add] = '\0';
    }
}

status child_ask(const char *const *argv, struct text *out, char said[512], int *code)
{
    int one[2], two[2];
    said[0] = '\0';
    if (pipe2(one, O_CLOEXEC) != 0)
        return fail(E_MEMORY, "%s: no pipe: %s", argv[0], strerror(errno));
    if (pipe2(two, O_CLOEXEC) != 0) {
        close(one[0]);
        close(one[1]);
        return fail(E_MEMORY, "%s: no pipe: %s", argv[0], strerror(errno));
    }
    fflush(NULL);
    pid_t pid = fork();
    if (pid == 0) {
        int in = open("/dev/null", O_RDONLY);
        default_signals();
        if (in < 0 || dup2(in, 0) < 0 || dup2(one[1], 1) < 0 || dup2(two[1], 2) < 0)
            _exit(NOT_FOUND - 1);
        execvp(argv[0], (char *const *)argv);
        _exit(NOT_FOUND);
    }
    close(one[1]);
    close(two[1]);
    bool open_one = pid > 0, open_two = pid > 0;
    while (open_one || open_two) {
        struct pollfd wait[2] = {{.fd = open_one ? one[0] : -1, .events = POLLIN},
                                 {.fd = open_two ? two[0] : -1, .events = POLLIN}};
        if (poll(wait, 2, -1) < 0 && errno != EINTR)
            break;
        if (wait[0].revents)
            drain(one[0], out, NULL, &open_one);
        if (wait[1].revents)
            drain(two[0], NULL, said, &open_two);
    }
    close(one[0]);
    close(two[0]);
    if (pid < 0)
        return fail(E_MEMORY, "%s: no new process", argv[0]);
    int how = 0;
    while (waitpid(pid, &how, 0) < 0 && errno == EINTR)
        ;
    *code = WIFEXITED(how) ? WEXITSTATUS(how) : 128 + WTERMSIG(how);
    for (char *s = said; *s; s++)
        if ((unsigned char)*s < 0x20)
            *s = ' ';
    return text_status(out);
}
