/* The acceptance kit: is this machine right, and how fast is it? What `hoodoo selftest` runs on a new node.
 *
 * What it needs      A device, and a temporary folder, which it removes. Its jobs are in the program.
 * What it goes by    Plain C for the kernels that have such (primitives); the variants of kernels, a second run and a resumed one,
 *                    bit for bit, for the models; numbers recorded on lavapipe for what would be wrong alike every time.
 */
#ifndef HOODOO_SELFTEST_H
#define HOODOO_SELFTEST_H

#include "base/path.h"
#include "selftest/compare.h"
#include "selftest/findings.h"

struct selftest {
    const char *device; /* gpu_options */
    const char *const *
        demo; /* the demo's job: lines, each with its end, the last NULL; its speed and its picture are taken */
    bool quick;
    bool (*stop)(void);

    /* The rest is the kit's own. */
    struct path folder; /* temporary */
    struct findings findings;
};

/* All checks. OK: they were made, and *t's report says what they found: selftest_end(). A check that fails is a row that is not ok;
 * once a device is lost, none follows. E_DEVICE: there is no such device. E_OUTPUT: no temporary folder. STOPPED. */
MUST_USE status selftest_run(struct selftest *t);
void selftest_end(struct selftest *t);

/* ---- for the parts */

/* A check of `what`: OK, with what it found in the row. An error makes the row not ok. */
typedef status (*selftest_check)(struct selftest *t, const void *what, struct row *row);

/* Makes it a row. Only what ends the kit is returned: E_DEVICE, E_OUTPUT, STOPPED. */
MUST_USE status selftest_do(struct selftest *t, const char *group, const char *name, selftest_check check,
                            const void *what);

/* STOPPED where a stop is wanted. */
MUST_USE status selftest_stop(const struct selftest *t);

/* The job of these lines, with `sets` over it. */
MUST_USE status selftest_load(struct selftest *t, const char *const *line, const char *const *sets,
                              size_t n_sets, struct job **out);

MUST_USE status selftest_primitives(struct selftest *t);
MUST_USE status selftest_models(struct selftest *t);
MUST_USE status selftest_speed(struct selftest *t);
MUST_USE status selftest_memory(struct selftest *t);
MUST_USE status selftest_picture(struct selftest *t);

/* The small jobs, and what their last frames were on lavapipe. */
struct trial {
    const char *name;
    const char *const *line;
    struct measure recorded;
};
extern const struct trial trials[];
extern const size_t n_trials;

#endif
