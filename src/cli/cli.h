/* The verbs: `hoodoo VERB ...` calls cli_VERB() with argv[0] = VERB. There is one file per verb.
 *
 * A verb parses its arguments with options_parse(&usage_VERB, ...), does its work and returns a status. Results go to stdout,
 * everything else to stderr. main() prints the message of a failure.
 */
#ifndef HOODOO_CLI_H
#define HOODOO_CLI_H

#include "base/path.h"
#include "base/status.h"
#include "cli/options.h"

/*    verb     operands  what it does */
#define VERBS(X)                                                                                             \
    X(run, "JOB", "simulate; continues automatically if the output folder holds part of this job")           \
    X(new, "[NAME]", "write NAME.yaml, a commented job to start from, copied from an example")               \
    X(keys, "[WHAT]", "describe the keys of jobs: those of a section, one key, or all that mention a word")  \
    X(check, "JOB", "report errors in a job and settings with surprising effects; needs no device")          \
    X(look, "JOB",                                                                                           \
      "a picture of one frame in seconds, without an output folder; with --watch again at each save")        \
    X(plan, "JOB", "estimate frames, particles, memory, disk, time and farm tasks; writes nothing")          \
    X(status, "OUT", "frames done, missing and damaged, checkpoints, rate, time left")                       \
    X(verify, "OUT", "check every file against its manifest; lists damaged and missing files")               \
    X(aov, "OUT", "render AOVs from the frames' VDBs: other cameras, resolutions or layers")                 \
    X(mesh, "OUT", "a surface mesh per frame (PLY, OBJ, USD)")                                               \
    X(submit, "JOB [ARG...]",                                                                                \
      "run the job's tasks on this machine or Slurm, or write them for OpenJD, OpenCue or another farm")     \
    X(cancel, "OUT", "stop a submitted job's tasks; what is done stays")                                     \
    X(retry, "OUT [TASK]", "submit again what is not done, or one task and those that wait for it")          \
    X(preview, "OUT", "POV-Ray stills, turntable, contact sheet and video")                                  \
    X(report, "OUT", "one static HTML page: pictures, curves, provenance, timing")                           \
    X(inspect, "FILE", "describe a checkpoint, VDB, EXR, manifest or run.json")                              \
    X(devices, "", "list the Vulkan devices: index, name, UUID, PCI address, memory")                        \
    X(selftest, "", "check this machine's results and speed: kernels, models, memory, the demo")

#define VERB_DECLARE(verb, operands, summary)                                                                \
    MUST_USE status cli_##verb(int argc, char **argv);                                                       \
    extern const struct usage usage_##verb;
VERBS(VERB_DECLARE)
#undef VERB_DECLARE

/* The folder `root`, or the folder of wedge `wedge` in it if that is above 0. E_USAGE: the number is out of range, or the path
 * is too long. */
MUST_USE status wedge_folder(const char *root, int wedge, struct path *out);

/* Lists the frames in `range` (step 0: all) that have volumes, in ascending order; *frames is released with free(). E_INPUT if
 * there are none. */
MUST_USE status volume_frames(const char *root, const char *name, struct frame_range range, int **frames,
                              size_t *n);

/* The frame range of the job in the output folder `root`, read from its job.yaml. */
MUST_USE status job_frames(const char *root, struct frame_range *out);

#endif
