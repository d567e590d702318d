/* Runs other programs as child processes, without a shell, and makes sure that none is left running.
 *
 * Environment   A child has an empty stdin, default signal handlers and its own process group, so that Ctrl-C in a terminal
 *               reaches only this process. It inherits no descriptors except those passed to it. The kernel signals it when
 *               the thread that started it ends.
 * Start         Uses vfork(): the memory of this process, which may be large and in use by other threads, is not copied.
 * Exit codes    126: the child could not be set up (its folder, its log). 127: there is no such program.
 * Threads       Different threads may use different children; a child belongs to one thread.
 */
#ifndef HOODOO_CHILD_H
#define HOODOO_CHILD_H

#include <stdbool.h>
#include <stddef.h>
#include <sys/types.h>

#include "base/status.h"
#include "text/text.h"

enum { CHILD_NOT_SET_UP = 126, CHILD_NO_PROGRAM = 127 };

struct child {
    pid_t pid; /* 0: no child */
    int fd;    /* its pidfd, or -1 if the kernel does not support these */
};

struct child_variable {
    const char *name, *value; /* ignored if name is NULL or the user has set the variable */
};

struct child_options {
    const char *const *argv; /* argv[0] is searched in PATH; ends with NULL */
    const char *folder;      /* its working directory; NULL: that of this process */
    const char *log; /* file, relative to `folder`, to which stdout and stderr are appended, or NULL */
    int out, err;    /* descriptors that become stdout and stderr; 0: the log, or /dev/null without one */
    const int *pass; /* descriptors that become 3, 4, ... */
    size_t n_pass;
    const struct child_variable *variable;
    size_t n_variables;
    int death_signal; /* sent to it when the thread that started it ends; 0: SIGKILL */
};

/* Starts a child. E_MEMORY if no process can be created. */
MUST_USE status child_start(const struct child_options *options, struct child *out);

/* Waits at most `seconds` (negative: without limit) for one of n children to end, reaps it, sets its pid to 0 and *how to the status of
 * waitpid(), and returns its index. Returns n if none has ended or a signal interrupted the wait. */
size_t child_wait(struct child *child, size_t n, double seconds, int *how);

/* Kills and reaps a child; no effect if there is none. */
void child_kill(struct child *child);

/* Describes why a child failed: its exit code or signal, and the last message of hoodoo in `log`. */
void child_reason(int how, const char *log, char *out, size_t size);

/* Runs argv until it ends. Its stdout is added to `out`, `errors` receives the last 500 bytes of its stderr, and *code its exit code (128 +
 * the number of the signal if it was killed). E_INPUT if it takes longer than `seconds`. */
MUST_USE status child_ask(const char *const *argv, double seconds, struct text *out, char errors[512],
                          int *code);

/* ---- several children in parallel
 *
 * Calling sequence   children_begin(), any number of children_run() and children_wait(), children_end(). After a failure
 *                    children_end() kills the children that are still running.
 * Paths              A child's working directory is `folder`, and its output goes to `log` (relative to folder). Paths given to
 *                    it should be relative and of plain names, because programs give '%', '#' and '-' a meaning.
 * Errors             E_INPUT: the program is not installed. E_OUTPUT: it failed; the message names the log. STOPPED: a stop was
 *                    requested (signals.h).
 */
enum { CHILDREN_MAX = 64 };

struct children {
    const char *folder, *log, *packages;
    int at_once; /* limit of children running at the same time */
    int n;
    struct child child[CHILDREN_MAX];
    struct children_job {
        const char *what; /* "the still of frame 1001", for messages; borrowed until the child ends */
        status (*done)(void *user); /* called after success */
        void *user;
    } job[CHILDREN_MAX];
};

/* `packages`: the packages to install if a program is missing, for the message. */
void children_begin(struct children *c, const char *folder, const char *log, const char *packages,
                    int at_once);

/* Starts argv[0], after waiting until fewer than at_once children are running. */
MUST_USE status children_run(struct children *c, const char *const *argv, const char *what,
                             status (*done)(void *user), void *user);

/* Waits for all children. */
MUST_USE status children_wait(struct children *c);

/* Kills and reaps all children that are still running, if any. */
void children_end(struct children *c);

#endif
