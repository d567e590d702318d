/* Several children in parallel. */
#include <string.h>
#include <sys/wait.h>

#include "system/child.h"
#include "system/signals.h"

/* Interval at which a stop is noticed whose signal went to another thread. */
static const double POLL_S = 0.05;

void children_begin(struct children *c, const char *folder, const char *log, const char *packages,
                    int at_once)
{
    *c = (struct children){.folder = folder, .log = log, .packages = packages, .at_once = at_once};
    if (c->at_once > CHILDREN_MAX)
        c->at_once = CHILDREN_MAX;
}

/* Removes child i, which has ended, from the list, and reports its failure or calls `done`. */
static status finish_child(struct children *c, size_t i, int how)
{
    const struct children_job job = c->job[i];
    c->n--;
    c->child[i] = c->child[c->n];
    c->job[i] = c->job[c->n];
    if (WIFEXITED(how) && WEXITSTATUS(how) == CHILD_NO_PROGRAM)
        return fail(E_INPUT, "%s: a program is missing; install %s", job.what, c->packages);
    if (!WIFEXITED(how) || WEXITSTATUS(how) != 0)
        return fail(E_OUTPUT, "%s could not be made (%s %d); see the program's output in %s/%s", job.what,
                    WIFEXITED(how) ? "exit" : "signal", WIFEXITED(how) ? WEXITSTATUS(how) : WTERMSIG(how),
                    c->folder, c->log);
    return job.done ? job.done(job.user) : OK;
}

static status wait_below(struct children *c, int limit)
{
    status st = OK;
    while (st == OK && c->n >= limit && c->n > 0) {
        int how = 0;
        if (stop_requested())
            return fail(STOPPED, "stopped; run the same command again to go on");
        size_t i = child_wait(c->child, (size_t)c->n, POLL_S, &how);
        if (i < (size_t)c->n)
            st = finish_child(c, i, how);
    }
    return st;
}

status children_run(struct children *c, const char *const *argv, const char *what, status (*done)(void *user),
                    void *user)
{
    status st = OK;
    TRY(wait_below(c, c->at_once));
    if (stop_requested())
        return fail(STOPPED, "stopped; run the same command again to go on");
    TRY(child_start(&(struct child_options){.argv = argv, .folder = c->folder, .log = c->log},
                    &c->child[c->n]));
    c->job[c->n++] = (struct children_job){what, done, user};
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
        child_kill(&c->child[i]);
    c->n = 0;
}
