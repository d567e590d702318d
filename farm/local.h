/* Local back end: one worker per device of this machine, each a child process that runs one task at a time.
 *
 * Order       A task starts when every task it waits for is done and a worker is free; simulation goes first.
 * Done        Tasks whose files are complete are not run, so that the same call continues where an earlier one stopped.
 * Failures    A failed task is tried again (farm.retries), after a pause, unless its exit code says that this cannot help. Tasks that
 *             wait for one that failed for good are left out; all others are done. The task that ends the job runs in any case.
 * Stop        Children get SIGTERM, save and exit; then STOPPED. They also get it if this process dies.
 * Logs        log/farm/TASK.log has a line for each start and end, with what the task wrote between them.
 */
#ifndef HOODOO_FARM_LOCAL_H
#define HOODOO_FARM_LOCAL_H

#include "farm/farm.h"

enum { LOCAL_WORKERS = 64 }; /* the most there can be */

struct local_worker {
    char device[128];  /* for --device; "" for the default */
    bool sims, others; /* which tasks it runs: those on a device, those on CPU cores */
    int threads;       /* of the CPU */
};

enum local_news { LOCAL_STARTED, LOCAL_DONE, LOCAL_AGAIN, LOCAL_FAILED, LOCAL_LEFT_OUT, LOCAL_SAVED };

struct local_state {
    size_t total, done, already, running, failed, left_out;
    double running_since[LOCAL_WORKERS];         /* monotonic, s */
    const struct farm_task *task[LOCAL_WORKERS]; /* NULL: idle */
};

struct local_options {
    const struct local_worker *worker;
    size_t n_workers;
    bool (*stop)(void);
    /* What happened to a task. `why`: the last message of a task that failed, the name of the task that one left out waits for, else "". */
    void (*news)(void *user, enum local_news what, const struct farm_task *t, int worker, double seconds,
                 const char *why);
    void (*tick)(void *user, const struct local_state *state); /* about once a second */
    void *user;
};

/* `gpus`: a list such as "0,1" or "uuid:...,pci:...", a worker for each and more for tasks without a GPU; or NULL. `workers`:
 * this many on the CPU device; or 0. Neither: every GPU, or one worker if there is none. E_USAGE, E_DEVICE. */
MUST_USE status local_workers(const char *gpus, int workers, struct local_worker out[LOCAL_WORKERS],
                              size_t *n);

/* Runs the chosen tasks. Returns the status of the first task that failed, STOPPED, or OK. */
MUST_USE status local_run(const struct farm *f, const struct local_options *options);

#endif
