/* Acceptance test of a machine, `hoodoo selftest`: does it compute correctly, and how fast?
 *
 * Needs      A device, and a temporary folder, which it removes. Its jobs are embedded in the program.
 * Criteria   Plain C for primitives. For models: bitwise equality of a second run, a resumed run and all variants of the kernels, and
 *            numbers recorded on lavapipe, which reveal errors that are the same in every run.
 */
#ifndef HOODOO_SELFTEST_H
#define HOODOO_SELFTEST_H

#include "base/path.h"
#include "selftest/compare.h"
#include "selftest/findings.h"

struct selftest {
    const char *device; /* gpu_options */
    const char *const *
        demo; /* lines of the demo's job, each with its newline, the last one NULL; used for speed and picture */
    bool quick;
    bool (*stop)(void);

    /* Private. */
    struct path folder; /* temporary */
    struct findings findings;
};

/* Runs all checks and fills t->findings; release with selftest_end(). A failed check is a row that is not ok, not an error. After the device is
 * lost, no further check runs. E_DEVICE: no such device. E_OUTPUT: no temporary folder. STOPPED. */
MUST_USE status selftest_run(struct selftest *t);
void selftest_end(struct selftest *t);

/* ---- for the files of this folder */

/* A check: returns OK with its findings in *row. An error makes the row not ok. `what` is the argument of selftest_do(). */
typedef status (*selftest_check)(struct selftest *t, const void *what, struct row *row);

/* Runs a check and adds its row. Returns only errors that end the self-test: E_DEVICE, E_OUTPUT, STOPPED. */
MUST_USE status selftest_do(struct selftest *t, const char *group, const char *name, selftest_check check,
                            const void *what);

/* STOPPED if a stop has been requested. */
MUST_USE status selftest_stop(const struct selftest *t);

/* Loads the job of these lines with the settings `sets`. */
MUST_USE status selftest_load(struct selftest *t, const char *const *line, const char *const *sets,
                              size_t n_sets, struct job **out);

MUST_USE status selftest_primitives(struct selftest *t);
MUST_USE status selftest_models(struct selftest *t);
MUST_USE status selftest_speed(struct selftest *t);
MUST_USE status selftest_memory(struct selftest *t);
MUST_USE status selftest_picture(struct selftest *t);

/* The small jobs, and the measures of their last frames on lavapipe. */
struct trial {
    const char *name;
    const char *const *line;
    struct measure recorded;
};
extern const struct trial trials[];
extern const size_t n_trials;

#endif
