/* What a task runs: a command line as a list of words, never a line for a shell.
 *
 * The words come from the command of the task's kind (kinds.def), in which names in braces stand for values:
 * "--frames={frames}" becomes "--frames=1001-1010".
 */
#ifndef HOODOO_FARM_COMMAND_H
#define HOODOO_FARM_COMMAND_H

#include "base/text.h"
#include "farm/farm.h"

#define COMMAND_VALUES(X)                                                                                    \
    X(job)      /* the job file that tasks read */                                                           \
    X(out)      /* the farm's output folder */                                                               \
    X(wedge)    /* which wedge */                                                                            \
    X(frames)   /* which frames */                                                                           \
    X(views)    /* how many views a turntable has */                                                         \
    X(view)     /* which of them */                                                                          \
    X(value)    /* which value of farm.show */                                                               \
    X(device)   /* for --device */                                                                           \
    X(camera)   /* whose pictures, if not the job's first */                                                 \
    X(jobs)     /* pictures made side by side */                                                             \
    X(map)      /* the file of a session's path mapping rules */                                             \
    X(gaps)     /* the option that says that some of the frames may have nothing to make */                  \
    X(progress) /* the style of progress */

/* NULL: no value, and the words that would have it are left out. */
struct command_values {
#define COMMAND_MEMBER(name) const char *name;
    COMMAND_VALUES(COMMAND_MEMBER)
#undef COMMAND_MEMBER
};

struct farm_command {
    const char *argv[20]; /* ends with NULL; points into `text` or at values */
    size_t n;
    char text[3 * PATH_BYTES + 1024];
};

/* hoodoo and the words of a kind's command, with these values. E_USAGE: they are too long. */
MUST_USE status command_fill(const char *hoodoo, enum farm_kind kind, const struct command_values *values,
                             struct farm_command *out);

/* The command of a task. `device`: for tasks that run on one, or NULL for none. `jobs`: pictures that may be made side
 * by side; 0 for as many as there are cores. */
MUST_USE status farm_command(const struct farm *f, const struct farm_task *t, const char *device, int jobs,
                             struct farm_command *out);

/* One word for a POSIX shell, whatever is in it. */
void farm_quote(struct text *out, const char *word);

/* Is trying the task again of no use? Wrong usage, another job's checkpoint, numbers that blew up. */
bool farm_final(int exit_code);

#endif
