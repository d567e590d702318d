/* Command lines, described by one table per verb from which both the parser and the help text are derived.
 *
 * Syntax   --name VALUE, --name=VALUE, flags, -h and --help, operands in any position, and "--", after which everything is an
 *          operand. If an option is given several times the last value counts, except for OPTION_LIST, which collects all.
 *          Options cannot be abbreviated: command lines stored on a farm must not become ambiguous when an option is added.
 * Errors   E_USAGE, with the argument, the closest known option, and where to find help.
 *
 *     struct common c = {0};
 *     struct arguments operands = {0};
 *     bool help = false;
 *     const struct option options[] = {OPTION_FRAMES(&c), OPTION_JSON(&c)};
 *     TRY(options_parse(&usage_status, options, sizeof options / sizeof *options, argc, argv, &operands, &help));
 *     if (help)
 *         goto done;
 */
#ifndef HOODOO_OPTIONS_H
#define HOODOO_OPTIONS_H

#include <stdbool.h>
#include <stddef.h>

#include "base/choice.h"
#include "base/status.h"
#include "system/progress.h"
#include "text/ranges.h"

/* A list of arguments in the order given. The strings belong to argv; arguments_free() frees the list. */
struct arguments {
    const char **item;
    size_t n, capacity;
};

MUST_USE status arguments_add(struct arguments *a, const char *argument);
void arguments_free(struct arguments *a);

enum option_kind {
    OPTION_FLAG,   /* bool: true if given */
    OPTION_TEXT,   /* const char * */
    OPTION_INT,    /* int */
    OPTION_NUMBER, /* double, finite */
    OPTION_RANGE,  /* struct frame_range; step 0 if not given */
    OPTION_CHOICE, /* int: index of the given name in `value` ("auto|bar|plain") */
    OPTION_LIST,   /* struct arguments; repeatable */
};

struct option {
    const char *name;  /* without the dashes */
    const char *value; /* name of the value in the help text, or the choices; NULL for flags */
    enum option_kind kind;
    void *target; /* receives the value, of the type given by `kind`; holds the default before */
    const char *help;
};

struct usage {
    const char *verb;
    const char *operands; /* "OUT", "OUT FILE", "FILE...", "[FILE]", or "" */
    const char *summary;
};

/* Parses the command line; argv[0] is the verb. With -h or --help, prints the help text to stdout and sets *help; the verb
 * then returns OK. E_USAGE also if the number of operands is wrong. */
MUST_USE status options_parse(const struct usage *usage, const struct option *options, size_t n, int argc,
                              char **argv, struct arguments *operands, bool *help);

/* ---- options that several verbs share; {0} is the default of every member */

#define RESUME_CHOICE                                                                                        \
    (RESUME_AUTO, "auto")(RESUME_NEVER, "never")(RESUME_REQUIRE, "require")(                                 \
        RESUME_OTHER_DEVICE, "other-device")(RESUME_OTHER_BUILD, "other-build")(RESUME_OTHER_BOTH,           \
                                                                                "other-device-and-build")
enum { CHOICE_CONSTANTS(RESUME_CHOICE) };

struct common {
    const char *out;           /* NULL: out/NAME */
    const char *device;        /* NULL: auto */
    const char *from;          /* OUT@FRAME, or NULL */
    struct frame_range frames; /* step 0: the job's */
    struct arguments sets;
    int progress; /* enum progress_style */
    int resume;   /* RESUME_* */
    bool json;
};

void common_free(struct common *c);

#define OPTION_OUT(c)                                                                                        \
    {                                                                                                        \
        "out", "DIR", OPTION_TEXT, &(c)->out, "output folder (default: out/NAME)"                            \
    }
#define OPTION_FRAMES(c)                                                                                     \
    {                                                                                                        \
        "frames", "RANGE", OPTION_RANGE, &(c)->frames,                                                       \
            "frames, such as 1001-1100 or 1001-1100x2 (default: the job's)"                                  \
    }
#define OPTION_DEVICE(c)                                                                                     \
    {                                                                                                        \
        "device", "WHICH", OPTION_TEXT, &(c)->device,                                                        \
            "auto, cpu, an INDEX, uuid:HEX, pci:ADDRESS or slurm (default: HOODOO_DEVICE, or auto)"          \
    }
#define OPTION_DEVICE_OR_NONE(c)                                                                                                    \
    {                                                                                                                               \
        "device", "WHICH", OPTION_TEXT, &(c)->device,                                                                               \
            "auto, cpu, an INDEX, uuid:HEX, pci:ADDRESS, slurm, or none to plan without a device (default: HOODOO_DEVICE, or auto)" \
    }
#define OPTION_SET(c)                                                                                        \
    {                                                                                                        \
        "set", "KEY=VALUE", OPTION_LIST, &(c)->sets,                                                         \
            "override a key of the job, such as domain.spacing_m=0.25; repeatable"                           \
    }
#define OPTION_PROGRESS(c)                                                                                   \
    {                                                                                                        \
        "progress", CHOICE_TEXT(PROGRESS_CHOICE), OPTION_CHOICE, &(c)->progress,                             \
            "how progress is shown; auto: a bar on a terminal, else plain lines"                             \
    }
#define OPTION_RESUME(c)                                                                                                                                                                                                                                                               \
    {                                                                                                                                                                                                                                                                                  \
        "resume", CHOICE_TEXT(RESUME_CHOICE), OPTION_CHOICE, &(c)->resume,                                                                                                                                                                                                             \
            "auto: continue from existing frames and checkpoints; never: discard the folder's manifests and checkpoints and start over; require: fail if there is no checkpoint; other-...: also continue from frames of another device or build, whose results are not bit-identical" \
    }
#define OPTION_FROM(c)                                                                                                                                                                                                                                   \
    {                                                                                                                                                                                                                                                    \
        "from", "OUT@FRAME", OPTION_TEXT, &(c)->from,                                                                                                                                                                                                    \
            "branch: start from another run's checkpoint of that frame (checkpoint.mark keeps it); the job may differ in everything except the size of the domain and the number of strata, and have a half, a quarter, twice, ... of the run's spacing" \
    }
#define OPTION_WEDGE(number)                                                                                 \
    {                                                                                                        \
        "wedge", "N", OPTION_INT, number, "use wedge N of the job, counted from 1"                           \
    }
#define OPTION_JSON(c)                                                                                       \
    {                                                                                                        \
        "json", NULL, OPTION_FLAG, &(c)->json, "print JSON"                                                  \
    }

#endif
