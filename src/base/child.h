/* Other programs, run as child processes: never through a shell, and never left behind.
 *
 * What a child gets   Its stdin is empty, signals have their defaults, and it is in a process group of its own: a
 *                     terminal's Ctrl-C reaches us alone, and we decide what becomes of it. It holds no descriptors
 *                     of ours but those it is passed. The kernel signals it when the thread that started it ends.
 * How it is started   Without a copy of this process's memory, which may be large and which threads may be changing.
 * Exit codes          126: it could not be set up (its folder, its log). 127: there is no such program.
 * Threads             Different children from different threads. A child from one.
 */
#ifndef HOODOO_CHILD_H
#define HOODOO_CHILD_H

#include <stdbool.h>
#include <stddef.h>
#include <sys/types.h>

#include "base/status.h"
#include "base/text.h"

enum { CHILD_NOT_SET_UP = 126, CHILD_NO_PROGRAM = 127 };

struct child {
    pid_t pid; /* 0: none */
    int fd;    /* its pidfd, or -1 where the kernel has none */
};

struct child_variable {
    const char *name, *value; /* name NULL: none. What the user has set stays */
};

struct child_options {
    const char *const *argv; /* argv[0] is found along PATH; NULL ends it */
    const char *folder;      /* its working directory; NULL: ours */
    const char *log;         /* stdout and stderr are appended to it (relative to folder); NULL: */
    int out, err;            /* descriptors that become stdout and stderr; 0: /dev/null */
    const int *pass;         /* descriptors that become 3, 4, ... */
    size_t n_pass;
    const struct child_variable *variable;
    size_t n_variables;
    int at_our_end; /* the signal it gets when the thread that started it ends; 0: SIGKILL */
};

/* E_MEMORY: no new process. */
MUST_USE status child_start(const struct child_options *options, struct child *out);

/* Waits `seconds` at most (negative: as long as it takes) for one of n children to end, reaps it, sets its pid to 0 and *how
 * as waitpid() does, and returns its index. n: none has ended, or a signal came. */
size_t child_wait(struct child *child, size_t n, double seconds, int *how);

/* Kills and reaps; harmless where there is none. */
void child_kill(struct child *child);

/* Why a child failed, for people: how it ended, and the last line of `log` that hoodoo said. */
void child_reason(int how, const char *log, char *out, size_t size);

/* Runs argv to its end: what it said on stdout in `out`, on stderr in `said` (the last 500 bytes), its exit code in *code
 * (128 + the number of the signal that killed it). E_INPUT: it took longer than `seconds`. */
MUST_USE status child_ask(const char *const *argv, double seconds, struct text *out, char said[512],
                          int *code);

/* ---- several side by side
 *
 * Calling sequence   children_begin(), any of children_run() and children_wait(), children_end(). After a failure
 *                    children_end() kills what still runs.
 * Where              A child's working directory is `folder`, and what it says goes to `log` (relative to folder).
 *                    Paths given to it should be relative, of safe names: programs have meanings for '%', '#' and '-' in
 *                    paths.
 * Errors             E_INPUT: the program is not installed. E_OUTPUT: it failed; the sentence names the log.
 *                    STOPPED: a stop was requested (signals.h).
 */
enum { CHILDREN_MAX = 64 };

struct children {
    const char *folder, *log, *packages;
    int at_once; /* how many may run side by side */
    int n;
    struct child child[CHILDREN_MAX];
    struct children_job {
        const char *what; /* "the still of frame 1001": for the sentence; outlives the child */
        /* Called when it has succeeded. */
        status (*done)(void *user);
        void *user;
    } job[CHILDREN_MAX];
};

/* `packages`: what to install where a program is missing, for the sentence. */
void children_begin(struct children *c, const char *folder, const char *log, const char *packages,
                    int at_once);

/* Starts argv[0], waiting first until fewer than at_once run. */
MUST_USE status children_run(struct children *c, const char *const *argv, const char *what,
                             status (*done)(void *user), void *user);

/* Waits for all. */
MUST_USE status children_wait(struct children *c);

/* Kills and reaps what is left. Harmless when nothing is. */
void children_end(struct children *c);

#endif
