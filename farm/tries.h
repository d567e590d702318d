/* What happened to a task: OUT/log/farm/TASK.jsonl, one JSON object a line, appended by whoever runs the task.
 *
 *     {"event": "submitted"}
 *     {"event": "start", "node": "n12", "job": "1234_5", "time": 1764512345}
 *     {"event": "end", "exit": 4, "seconds": 12}
 *     {"event": "stranded"}                        no node of its partition is left that is not excluded
 *     {"event": "excluded", "node": "n12"}         the node cannot run hoodoo (exit 126 or 127)
 *     {"event": "cancelled"}
 *
 * Tries and failures count from the last submission. `time` is in seconds since 1970 by the node's clock, and only shown.
 */
#ifndef HOODOO_FARM_TRIES_H
#define HOODOO_FARM_TRIES_H

#include "farm/farm.h"
#include "text/text.h"

struct farm_tries {
    int starts;   /* since the last submission */
    bool running; /* the last start has no end: it runs, or was killed before it could say so */
    bool cancelled;
    int exit_code;      /* of the last end; -1: none */
    double seconds;     /* of the last try; of one without an end, up to now by this machine's clock */
    char node[128];     /* of the last start */
    bool stranded;      /* no node is left that is not excluded */
    char excluded[512]; /* nodes with commas between */
};

/* A task without such a file has {.exit_code = -1}. Lines that cannot be read are skipped: a machine may have died in one. */
MUST_USE status tries_read(const struct farm *f, const struct farm_task *t, struct farm_tries *out);

MUST_USE status tries_path(const struct farm *f, const struct farm_task *t, struct path *out);

/* Append a line. */
MUST_USE status tries_add(const struct farm *f, const struct farm_task *t, const char *event);
MUST_USE status tries_add_start(const struct farm *f, const struct farm_task *t, const char *job);
MUST_USE status tries_add_end(const struct farm *f, const struct farm_task *t, int exit_code, double seconds);

/* "input file missing, damaged or hostile", "killed by signal 9 (Killed)": what an exit code says. */
const char *farm_exit_meaning(int code, char out[160]);

#endif
