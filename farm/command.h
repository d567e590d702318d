/* The command of a task, as a list of arguments; no shell reads it.
 *
 * It is made from the template of the task's kind (kinds.def), in which names in braces stand for values: "--frames={frames}"
 * becomes "--frames=1001-1010".
 */
#ifndef HOODOO_FARM_COMMAND_H
#define HOODOO_FARM_COMMAND_H

#include "farm/farm.h"
#include "text/text.h"

#define COMMAND_VALUES(X)                                                                                    \
    X(job)      /* the job file that tasks read */                                                           \
    X(out)      /* the farm's output folder */                                                               \
    X(wedge)    /* number of the wedge */                                                                    \
    X(frames)   /* range of frames */                                                                        \
    X(views)    /* number of views of a turntable */                                                         \
    X(view)     /* range of views */                                                                         \
    X(value)    /* value of farm.show */                                                                     \
    X(device)   /* argument of --device */                                                                   \
    X(camera)   /* camera, if not the job's first */                                                         \
    X(jobs)     /* number of pictures that are made at a time */                                             \
    X(map)      /* file of an OpenJD session's path mapping rules */                                         \
    X(gaps)     /* option that allows frames of which nothing is made */                                     \
    X(progress) /* the style of progress */

/* Arguments of the template whose value is NULL are left out. */
struct command_values {
#define COMMAND_MEMBER(name) const char *name;
    COMMAND_VALUES(COMMAND_MEMBER)
#undef COMMAND_MEMBER
};

enum { COMMAND_ARGUMENTS = 20, COMMAND_PROLOGUE = 43 };

struct farm_command {
    const char
        *argv[COMMAND_PROLOGUE + COMMAND_ARGUMENTS + 1]; /* ends with NULL; points into `text` and the job */
    size_t n;
    char text[3 * PATH_BYTES + 1024];
};

/* What a task's command begins with: words that a user puts before it, and the program. */
struct command_head {
    const char *hoodoo;
    char *const *prologue; /* [n_prologue] */
    size_t n_prologue;
};

/* The head of the tasks of a kind, by the job's keys farm.KIND.binary and farm.KIND.prologue, or else farm.binary and farm.prologue.
 * `hoodoo`: the program if the job names none. Borrows from both. */
struct command_head command_head(const struct job *job, enum farm_kind kind, const char *hoodoo);

/* E_USAGE: a prologue of the job is longer than COMMAND_PROLOGUE. */
MUST_USE status command_check(const struct job *job);

/* Fills in the template of a kind. The head is borrowed. E_USAGE: the command is too long. */
MUST_USE status command_fill(const struct command_head *head, enum farm_kind kind,
                             const struct command_values *values, struct farm_command *out);

/* The command of a task, which borrows from `f`. `device`: for tasks that run on a device; NULL: the default. `jobs`: how many
 * pictures may be made at a time; 0: as many as there are cores. E_USAGE. */
MUST_USE status farm_command(const struct farm *f, const struct farm_task *t, const char *device, int jobs,
                             struct farm_command *out);

/* Appends `argument` quoted for a POSIX shell. */
void farm_quote(struct text *out, const char *argument);

/* Whether another try of a task with this exit code cannot help: wrong usage, a checkpoint that does not fit, an unstable
 * computation. */
bool farm_final(int exit_code);

#endif
