/* Other programs, run as children: never through a shell, killed and reaped when we are asked to stop.
 *
 * Calling sequence   children_begin(), any of children_run() and children_wait(), children_end(). After a
 *                    failure children_end() kills what still runs.
 * Where              A child's working directory is `folder`, its stdin is empty, and what it says goes to
 *                    `log` (relative to folder). Paths given to it should be relative, of safe names:
 *                    programs have meanings for '%', '#' and '-' in paths.
 * Errors             E_INPUT: the program is not installed. E_OUTPUT: it failed; the sentence names the log.
 *                    STOPPED: a stop was requested.
 */
#ifndef HOODOO_CHILD_H
#define HOODOO_CHILD_H

#include <sys/types.h>

#include "base/status.h"

enum { CHILDREN_MAX = 64 };

struct children {
    const char *folder, *log;
    int at_once; /* how many may run side by side */
    int n;
    struct {
        pid_t pid;
        const char *what; /* "the still of frame 1001": for the sentence; outlives the child */
        /* Called when it has succeeded. */
        status (*done)(void *user);
        void *user;
    } child[CHILDREN_MAX];
};

void children_begin(struct children *c, const char *folder, const char *log, int at_once);

/* Starts argv[0] (found along PATH; argv ends with NULL), waiting first until fewer than at_once run. */
MUST_USE status children_run(struct children *c, const char *const *argv, const char *what,
                             status (*done)(void *user), void *user);

/* Waits for all. */
MUST_USE status children_wait(struct children *c);

/* Kills and reaps what is left. Harmless when nothing is. */
void children_end(struct children *c);

#endif
