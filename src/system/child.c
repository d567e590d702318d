#include "system/child.h"

#include <errno.h>
#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/pidfd.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include "base/clock.h"
#include "base/memory.h"
#include "system/signals.h"

enum { BLIND_MS = 10, HIGH = 64 };

/* ---- start */

/* Moves descriptors to their final numbers, after copying all to high numbers so that they do not overwrite each other. Returns false on
 * failure. */
static bool place_descriptors(const struct child_options *o)
{
    int in = open("/dev/null", O_RDWR | O_CLOEXEC);
    int log = o->log ? open(o->log, O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0666) : in;
    int to[3] = {in, o->out > 0 ? o->out : log, o->err > 0 ? o->err : log};
    const int n = 3 + (int)o->n_pass;
    for (int i = 0; i < n; i++)
        if (fcntl(i < 3 ? to[i] : o->pass[i - 3], F_DUPFD_CLOEXEC, HIGH + i) != HIGH + i)
            return false;
    for (int i = 0; i < n; i++)
        if (dup2(HIGH + i, i) < 0)
            return false;
    close_range((unsigned)n, ~0U,
                CLOSE_RANGE_CLOEXEC); /* for descriptors that libraries opened without O_CLOEXEC */
    return true;
}

/* Runs in the child, which shares the memory of this process until exec and therefore must not change it. */
static _Noreturn void exec_child(const struct child_options *o, char *const *environment, pid_t parent)
{
    sigset_t none;
    signals_reset();
    sigemptyset(&none);
    sigprocmask(SIG_SETMASK, &none, NULL);
    setpgid(0, 0);
    prctl(PR_SET_PDEATHSIG, o->death_signal ? o->death_signal : SIGKILL);
    if (getppid() != parent)
        _exit(CHILD_NOT_SET_UP);
    if ((o->folder && chdir(o->folder) != 0) || !place_descriptors(o))
        _exit(CHILD_NOT_SET_UP);
    execvpe(o->argv[0], (char *const *)o->argv, environment);
    _exit(CHILD_NO_PROGRAM);
}

/* A separate function, because no variable of its caller may change between the two returns of vfork(). Signals are blocked so that no
 * handler of this process runs in the child. */
static __attribute__((noinline)) pid_t launch(const struct child_options *o, char *const *environment)
{
    sigset_t all, before;
    const pid_t parent = getpid();
    sigfillset(&all);
    pthread_sigmask(SIG_SETMASK, &all, &before);
    pid_t pid = vfork();
    if (pid == 0)
        exec_child(o, environment, parent);
    pthread_sigmask(SIG_SETMASK, &before, NULL);
    return pid;
}

/* The environment of this process with those of the variables that it lacks; their "NAME=value" strings follow the array. */
static status make_environment(const struct child_options *o, char ***out)
{
    size_t n = 0, bytes = 0;
    while (environ[n])
        n++;
    for (size_t i = 0; i < o->n_variables; i++)
        if (o->variable[i].name)
            bytes += strlen(o->variable[i].name) + strlen(o->variable[i].value) + 2;
    char **made = NULL;
    status st = memory_alloc((n + o->n_variables + 1) * sizeof *made + bytes, 1, "an environment", &made);
    if (st != OK)
        return st;
    char *at = (char *)(made + n + o->n_variables + 1);
    memcpy(made, environ, n * sizeof *made);
    for (size_t i = 0; i < o->n_variables; i++) {
        const struct child_variable *v = &o->variable[i];
        if (v->name && !getenv(v->name)) {
            made[n++] = at;
            at += sprintf(at, "%s=%s", v->name, v->value) + 1;
        }
    }
    made[n] = NULL;
    *out = made;
    return OK;
}

status child_start(const struct child_options *o, struct child *out)
{
    char **environment = NULL;
    status st = make_environment(o, &environment);
    if (st != OK)
        return st;
    /* If the parent process left it ignored, waitpid() would not report how a child ended. */
    signal(SIGCHLD, SIG_DFL);
    fflush(NULL); /* so that earlier output precedes the child's */
    pid_t pid = launch(o, environment);
    int error = errno;
    free(environment);
    if (pid < 0)
        return fail(E_MEMORY, "%s: cannot start a process: %s", o->argv[0], strerror(error));
    *out = (struct child){.pid = pid, .fd = pidfd_open(pid, 0)};
    return OK;
}

/* ---- end */

static void clear_child(struct child *child)
{
    if (child->fd >= 0)
        close(child->fd);
    *child = (struct child){0};
}

static size_t reap(struct child *child, size_t n, int *how)
{
    for (size_t i = 0; i < n; i++) {
        if (!child[i].pid)
            continue;
        pid_t pid = waitpid(child[i].pid, how, WNOHANG);
        if (pid == 0 || (pid < 0 && errno == EINTR))
            continue;
        if (pid < 0) /* already reaped elsewhere: its exit code is unknown */
            *how = CHILD_NOT_SET_UP << 8;
        clear_child(&child[i]);
        return i;
    }
    return n;
}

size_t child_wait(struct child *child, size_t n, double seconds, int *how)
{
    struct pollfd wait[CHILDREN_MAX];
    const double until = clock_seconds() + seconds;
    for (;;) {
        size_t ended = reap(child, n, how), k = 0;
        double left = until - clock_seconds();
        bool blind = n > CHILDREN_MAX;
        if (ended < n || (seconds >= 0 && left <= 0))
            return ended;
        for (size_t i = 0; i < n && !blind; i++)
            if (child[i].pid) {
                blind = child[i].fd < 0;
                wait[k++] = (struct pollfd){.fd = child[i].fd, .events = POLLIN};
            }
        int ms = seconds < 0 || left > 1e6 ? -1 : (int)(left * 1000) + 1;
        if (blind && (ms < 0 || ms > BLIND_MS))
            ms = BLIND_MS;
        if (poll(wait, blind ? 0 : (nfds_t)k, ms) < 0)
            return reap(child, n, how);
    }
}

void child_kill(struct child *child)
{
    if (!child->pid)
        return;
    kill(child->pid, SIGKILL);
    while (waitpid(child->pid, NULL, 0) < 0 && errno == EINTR)
        ;
    clear_child(child);
}
