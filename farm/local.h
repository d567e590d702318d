/* The farm that is this machine: one worker per device, each a child process that runs one task at a time.
 *
 * Order       A task starts when all it waits for is done and a worker is free; simulation goes first.
 * Done        What the files say is done is not run again, so the same call goes on where it was.
 * Failures    A task is tried again (farm.retries), after a pause, unless its exit code says that it is of no
 *             use. What waits for a task that failed for good is left out; everything else is done.
 * Stop        Children get SIGTERM, save and end; then STOPPED. If this process dies, they get it too.
 */
#ifndef HOODOO_FARM_LOCAL_H
#define HOODOO_FARM_LOCAL_H

#include "farm/farm.h"

/* At most 64 workers. */
enum { LOCAL_WORKERS = 64 };

struct local_worker {
    char device[128];  /* for --device; "" for the default one */
    bool sims, others; /* which tasks it takes */
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
    /* What happened to a task: `why` is its last words where it failed, else "". */
    void (*news)(void *user, enum local_news what, const struct farm_task *t, int worker, double seconds,
                 const char *why);
    void (*tick)(void *user, const struct local_state *state); /* about once a second */
    void *user;
};

/* `gpus`: "0,1" or "uuid:...,pci:...", a worker each, and more for what needs no GPU; or NULL. `workers`: this
 * many on the CPU device; or 0. Neither: every GPU there is, or one worker. E_USAGE, E_DEVICE. */
MUST_USE status local_workers(const char *gpus, int workers, struct local_worker out[LOCAL_WORKERS],
                              size_t *n);

/* Works the graph off. The status of the first task that failed, STOPPED, or OK. */
MUST_USE status local_run(const struct farm *f, const struct local_options *options);

#endif
