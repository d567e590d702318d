/* The command of a task, as a list of arguments; no shell reads it.
 *
 * It is made from the template of the task's kind (kinds.def), in which names in braces stand for values: "--frames={frames}"
 * becomes "--frames=1001-1010".
 */
#ifndef HOODOO_FARM_COMMAND_H
#define HOODOO_FARM_COMMAND_H

#include "base/text.h"
#include "farm/farm.h"

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

struct farm_command {
    const char *argv[20]; /* ends with NULL; points into `text` */
    size_t n;
    char text[3 * PATH_BYTES + 1024];
};

/* Fills in the template of a kind. argv[0] is `hoodoo`, which is borrowed. E_USAGE: the command is too long. */
MUST_USE status command_fill(const char *hoodoo, enum farm_kind kind, const struct command_values *values,
                             struct farm_command *out);

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
