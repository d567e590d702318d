#include "render/child.h"

#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <stdio.h>
#include <string.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include "base/signals.h"

enum { NOT_FOUND = 127, POLL_US = 5000 };

void children_begin(struct children *c, const char *folder, const char *log, int at_once)
{
    *c = (struct children){.folder = folder, .log = log, .at_once = at_once};
    if (c->at_once > CHILDREN_MAX)
        c->at_once = CHILDREN_MAX;
}

static void become(const struct children *c, const char *const *argv, pid_t parent)
{
    signals_reset();
    /* What a killed parent has begun nobody waits for any more. */
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    if (getppid() != parent)
        _exit(126);
    if (chdir(c->folder) != 0)
        _exit(126);
    int in = open("/dev/null", O_RDONLY), out = open(c->log, O_WRONLY | O_CREAT | O_APPEND, 0666);
    if (in < 0 || out < 0 || dup2(in, 0) < 0 || dup2(out, 1) < 0 || dup2(out, 2) < 0)
        _exit(126);
    /* A group of its own: a terminal's Ctrl-C reaches us alone, and we decide what becomes of it. */
    setpgid(0, 0);
    execvp(argv[0], (char *const *)argv);
    _exit(NOT_FOUND);
}

/* Takes finished children out of the list. */
static status reap(struct children *c)
{
    status st = OK;
    for (int i = 0; i < c->n; i++) {
        int how;
        pid_t pid = waitpid(c->child[i].pid, &how, WNOHANG);
        if (pid == 0 || (pid < 0 && errno == EINTR))
            continue;
        const char *what = c->child[i].what;
        status (*done)(void *) = c->child[i].done;
        void *user = c->child[i].user;
        c->child[i--] = c->child[--c->n];
        if (pid < 0)
            return fail(E_OUTPUT, "%s: lost sight of its process: %s", what, strerror(errno));
        if (WIFEXITED(how) && WEXITSTATUS(how) == NOT_FOUND)
            return fail(E_INPUT, "%s: a program is missing; install povray, ffmpeg and openimageio-tools",
                        what);
        if (!WIFEXITED(how) || WEXITSTATUS(how) != 0)
            return fail(E_OUTPUT, "%s could not be made (%s %d); what the program said is in %s/%s", what,
                        WIFEXITED(how) ? "exit" : "signal", WIFEXITED(how) ? WEXITSTATUS(how) : WTERMSIG(how),
                        c->folder, c->log);
        if (done)
            TRY(done(user));
    }
done:
    return st;
}

static status wait_below(struct children *c, int limit)
{
    status st = OK;
    while (c->n >= limit && c->n > 0) {
        if (stop_requested())
            return fail(STOPPED, "stopped; run the same command again to go on");
        int before = c->n;
        TRY(reap(c));
        if (c->n == before)
            usleep(POLL_US);
    }
done:
    return st;
}

status children_run(struct children *c, const char *const *argv, const char *what, status (*done)(void *user),
                    void *user)
{
    status st = OK;
    TRY(wait_below(c, c->at_once));
    if (stop_requested())
        return fail(STOPPED, "stopped; run the same command again to go on");
    fflush(NULL);
    const pid_t self = getpid();
    pid_t pid = fork();
    if (pid < 0)
        return fail(E_MEMORY, "%s: no new process: %s", what, strerror(errno));
    if (pid == 0)
        become(c, argv, self);
    c->child[c->n].pid = pid;
    c->child[c->n].what = what;
    c->child[c->n].done = done;
    c->child[c->n].user = user;
    c->n++;
done:
    return st;
}

status children_wait(struct children *c)
{
    return wait_below(c, 1);
}

void children_end(struct children *c)
{
    for (int i = 0; i < c->n; i++)
        kill(c->child[i].pid, SIGKILL);
    for (int i = 0; i < c->n; i++)
        while (waitpid(c->child[i].pid, NULL, 0) < 0 && errno == EINTR)
            ;
    c->n = 0;
}
