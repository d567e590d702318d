/* A model's state as a checkpoint's sections. */
#ifndef HOODOO_SECTIONS_H
#define HOODOO_SECTIONS_H

#include <math.h>

#include "base/idset.h"
#include "checkpoint/checkpoint.h"
#include "job/job.h"
#include "particles/frame.h"

/* Adds a section of n items; *data is its memory, to be filled. */
MUST_USE status section_add(struct checkpoint *c, const char *name, size_t item, size_t n, void **data);

/* What a section has to hold, so that nothing in it can size or index what it does not fit. */
enum section_kind {
    SECTION_FLOAT,
    SECTION_WORD,
    SECTION_DOUBLE,
    SECTION_INTEGER
}; /* 4, 4, 8, 8 bytes; int64_t */

struct section_rule {
    const char *name;
    enum section_kind kind;
    size_t n;           /* items; SECTION_ANY: as many as there are, whole strides */
    size_t stride;      /* 1 to 4: item i has the range [i % stride] */
    double range[4][2]; /* least and most; what is no number is in none */
};
#define SECTION_ANY SIZE_MAX

/* Counts beyond are no counts: a double holds whole numbers up to it. */
#define SECTION_COUNT_MAX 9007199254740992.0
/* A range that holds every number. */
#define SECTION_ALL                                                                                          \
    {                                                                                                        \
        -INFINITY, INFINITY                                                                                  \
    }

/* Finds the section and checks it: *data is its items, *n (unless NULL) their number. E_CHECKPOINT names the section, and
 * the first item that is out of its range, with its value. */
MUST_USE status section_take(const struct checkpoint *c, const struct section_rule *rule, const void **data,
                             size_t *n);

/* The ranges of a place in the domain, give or take a spacing, and of a zero behind it. */
void section_place(double range[4][2], const int voxels[3], double h);

/* Further checks of what section_take() gave: the sentence for item i. */
status section_refuse(const struct checkpoint *c, const char *section, size_t i, const char *format, ...)
    PRINTF_LIKE(4, 5);

/* No two of n ids are equal, and each is below `bound`. They are added to *ids, which is empty. */
MUST_USE status section_check_ids(const struct checkpoint *c, const char *section, const uint32_t *id,
                                  size_t n, uint64_t bound, struct idset *ids);

/* start = rock + deposit + fallen + left, none negative and none more than a double counts. */
MUST_USE status section_take_ledger(const struct checkpoint *c, struct ledger *out);

/* What every model's checkpoint says of its domain: model, voxels, spacing and number of strata; and whether a job
 * has the same. E_CHECKPOINT says what differs. */
MUST_USE status section_add_domain(struct checkpoint *c, const struct job *job);
MUST_USE status section_check_domain(const struct checkpoint *c, const struct job *job);

#endif
