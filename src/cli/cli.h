/* The verbs: `hoodoo VERB ...` calls cli_VERB(), with argv[0] the verb. One file a verb.
 *
 * A verb parses its arguments with options_parse(&usage_VERB, ...), does its work, and returns a status; what
 * it prints for people and programs goes to stdout, everything else to stderr. main() prints the sentence of
 * a failure.
 */
#ifndef HOODOO_CLI_H
#define HOODOO_CLI_H

#include "base/path.h"
#include "base/status.h"
#include "cli/options.h"

/*    verb     operands  what it does */
#define VERBS(X)                                                                                             \
    X(run, "JOB", "simulate; resumes by itself when the output folder already holds part of this job")       \
    X(new, "[NAME]", "a commented job to begin with, NAME.yaml, from one of the examples")                   \
    X(keys, "[WHAT]",                                                                                        \
      "what may stand in a job: the keys of a section, one key, or all that speak of a word")                \
    X(check, "JOB", "what is wrong with a job, and what would surprise in it; no device")                    \
    X(look, "JOB", "a picture of one frame in seconds, without a folder; again at each save with --watch")   \
    X(plan, "JOB",                                                                                           \
      "what it would do: frames, particles, memory, disk, time, farm tasks (nothing is written)")            \
    X(status, "OUT", "frames done, missing and damaged, checkpoints, rate, time left")                       \
    X(verify, "OUT", "re-read every file against its manifest; names each damaged or missing one")           \
    X(aov, "OUT", "render AOVs again from the frames' VDBs: other cameras, resolution, layers")              \
    X(mesh, "OUT", "a surface mesh per frame (PLY, OBJ, USD)")                                               \
    X(submit, "JOB [ARG...]",                                                                                \
      "hand it to this machine's devices, to Slurm, or write its tasks for OpenJD or any other farm")        \
    X(preview, "OUT", "POV-Ray stills, turntable, contact sheet and video")                                  \
    X(report, "OUT", "one static HTML page: pictures, curves, provenance, timing")                           \
    X(inspect, "FILE", "what a checkpoint, VDB, EXR or manifest holds, in words or --json")                  \
    X(devices, "", "the Vulkan devices, by index, name, UUID, PCI address, memory")                          \
    X(selftest, "",                                                                                          \
      "is this machine right, and how fast: kernels, models, memory, the demo; a table or --json")

#define VERB_DECLARE(verb, operands, summary)                                                                \
    MUST_USE status cli_##verb(int argc, char **argv);                                                       \
    extern const struct usage usage_##verb;
VERBS(VERB_DECLARE)
#undef VERB_DECLARE

/* OUT, or with `wedge` > 0 that wedge's folder in it, in `out`. E_USAGE: there can be no such wedge, or the path is
 * too long. */
MUST_USE status wedge_folder(const char *root, int wedge, struct path *out);

/* The frames whose volumes a verb can read, of those in `range` (step 0: all), ascending; *frames freed with
 * free(). E_INPUT if there are none. */
MUST_USE status volume_frames(const char *root, const char *name, struct frame_range range, int **frames,
                              size_t *n);

/* The frames of the job in the output folder `root`, from its own copy of the job. */
MUST_USE status job_frames(const char *root, struct frame_range *out);

#endif
