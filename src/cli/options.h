/* Command lines, from a table per verb: the parser and the help text come from the same rows.
 *
 * Understood   --name VALUE, --name=VALUE, flags, -h and --help, operands anywhere, "--" (all that follows
 *              are operands). An option given twice counts the last time, but for OPTION_WORDS, which
 *              collects. No abbreviations: a farm's old command lines must not become ambiguous when an
 *              option is added.
 * Errors       E_USAGE names the argument, the nearest option there is, and where to look.
 *
 *     struct common c = {0};
 *     struct words operands = {0};
 *     bool help = false;
 *     const struct option options[] = {OPTION_FRAMES(&c), OPTION_JSON(&c)};
 *     TRY(options_parse(&usage_status, options, sizeof options / sizeof *options, argc, argv, &operands,
 *     &help)); if (help)
 *         goto done;
 */
#ifndef HOODOO_OPTIONS_H
#define HOODOO_OPTIONS_H

#include <stdbool.h>
#include <stddef.h>

#include "base/choice.h"
#include "base/progress.h"
#include "base/ranges.h"
#include "base/status.h"

/* Arguments in the order given. The texts are argv's; word itself is freed with words_free(). */
struct words {
    const char **word;
    size_t n, capacity;
};

MUST_USE status words_add(struct words *w, const char *word);
void words_free(struct words *w);

enum option_kind {
    OPTION_FLAG,   /* bool: true if given */
    OPTION_TEXT,   /* const char * */
    OPTION_INT,    /* int */
    OPTION_NUMBER, /* double, finite */
    OPTION_RANGE,  /* struct frame_range; step 0 as long as it is not given */
    OPTION_CHOICE, /* int: which of value's words ("auto|bar|plain") was given */
    OPTION_WORDS,  /* struct words; repeatable */
};

struct option {
    const char *name;  /* without the dashes */
    const char *value; /* what the help text calls its value; NULL for flags */
    enum option_kind kind;
    void *target; /* holds the preset; as `kind` says */
    const char *help;
};

struct usage {
    const char *verb;
    const char *operands; /* "OUT", "OUT FILE", "FILE...", "[FILE]", or "" */
    const char *summary;
};

/* argv[0] is the verb. With -h or --help the text goes to stdout and *help becomes true; the verb then
 * returns OK. E_USAGE as above, or when the number of operands is wrong. */
MUST_USE status options_parse(const struct usage *usage, const struct option *options, size_t n, int argc,
                              char **argv, struct words *operands, bool *help);

/* ---- what verbs share (DESIGN 2). {0} is right for every member. */

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
    struct words sets;
    int progress; /* enum progress_style */
    int resume;   /* RESUME_* */
    bool json;
};

void common_free(struct common *c);

#define OPTION_OUT(c)                                                                                        \
    {                                                                                                        \
        "out", "DIR", OPTION_TEXT, &(c)->out, "the output folder (default out/NAME)"                         \
    }
#define OPTION_FRAMES(c)                                                                                     \
    {                                                                                                        \
        "frames", "RANGE", OPTION_RANGE, &(c)->frames,                                                       \
            "such as 1001-1100 or 1001-1100x2 (default: the job's)"                                          \
    }
#define OPTION_DEVICE(c)                                                                                     \
    {                                                                                                        \
        "device", "WHICH", OPTION_TEXT, &(c)->device,                                                        \
            "auto, cpu, an INDEX, uuid:HEX, pci:ADDRESS or slurm (default HOODOO_DEVICE, or auto)"           \
    }
#define OPTION_DEVICE_OR_NONE(c)                                                                             \
    {                                                                                                        \
        "device", "WHICH", OPTION_TEXT, &(c)->device,                                                        \
            "auto, cpu, an INDEX, uuid:HEX, pci:ADDRESS, slurm or none: look at no device "                  \
            "(default HOODOO_DEVICE, or auto)"                                                               \
    }
#define OPTION_SET(c)                                                                                        \
    {                                                                                                        \
        "set", "KEY=VALUE", OPTION_WORDS, &(c)->sets,                                                        \
            "any key of the job, such as domain.spacing_m=0.25; repeatable"                                  \
    }
#define OPTION_PROGRESS(c)                                                                                   \
    {                                                                                                        \
        "progress", CHOICE_TEXT(PROGRESS_CHOICE), OPTION_CHOICE, &(c)->progress,                             \
            "auto: a bar on a terminal, else plain lines"                                                    \
    }
#define OPTION_RESUME(c)                                                                                     \
    {                                                                                                        \
        "resume", CHOICE_TEXT(RESUME_CHOICE), OPTION_CHOICE, &(c)->resume,                                   \
            "never: start over, which removes the folder's manifests and checkpoints; require: fail "        \
            "without a checkpoint; other-...: go on from what another device or build of hoodoo made, "      \
            "though not bit for bit"                                                                         \
    }
#define OPTION_FROM(c)                                                                                       \
    {                                                                                                        \
        "from", "OUT@FRAME", OPTION_TEXT, &(c)->from,                                                        \
            "a branch: begin with another run's checkpoint of that frame (kept by its checkpoint.mark); "    \
            "the job "                                                                                       \
            "may differ in all but domain and number of strata"                                              \
    }
#define OPTION_WEDGE(number)                                                                                 \
    {                                                                                                        \
        "wedge", "N", OPTION_INT, number, "one of the job's wedges, from 1"                                  \
    }
#define OPTION_JSON(c)                                                                                       \
    {                                                                                                        \
        "json", NULL, OPTION_FLAG, &(c)->json, "print JSON, for programs"                                    \
    }

#endif
