/* A model's state as a checkpoint's sections. */
#ifndef HOODOO_SECTIONS_H
#define HOODOO_SECTIONS_H

#include <math.h>

#include "base/idset.h"
#include "checkpoint/checkpoint.h"
#include "job/job.h"
#include "particles/frame.h"

/* Adds a section of n items of `item` bytes; *data is its memory, owned by the checkpoint, for the caller to fill. */
MUST_USE status section_add(struct checkpoint *c, const char *name, size_t item, size_t n, void **data);

/* The type, size and ranges that a section must have. Everything that sizes or indexes memory is checked this way. */
enum section_kind {
    SECTION_FLOAT,
    SECTION_WORD,
    SECTION_DOUBLE,
    SECTION_INTEGER
}; /* 4, 4, 8, 8 bytes; int64_t */

struct section_rule {
    const char *name;
    enum section_kind kind;
    size_t n;           /* items; SECTION_ANY: any multiple of stride */
    size_t stride;      /* 1 to 4; item i must be in range[i % stride] */
    double range[4][2]; /* least and most; a NaN is in no range */
};
#define SECTION_ANY SIZE_MAX

/* The largest count: doubles hold all whole numbers up to 2^53. */
#define SECTION_COUNT_MAX 9007199254740992.0
/* A range that holds every number. */
#define SECTION_ALL                                                                                          \
    {                                                                                                        \
        -INFINITY, INFINITY                                                                                  \
    }

/* Finds a section and checks it. *data points to its items, which the checkpoint owns, and *n (unless NULL) is their number.
 * E_CHECKPOINT, with the section and the first item that is out of range, and its value. */
MUST_USE status section_get(const struct checkpoint *c, const struct section_rule *rule, const void **data,
                            size_t *n);

/* The ranges of a position in the domain, with a margin of one spacing, whose fourth component is 0. */
void section_place(double range[4][2], const int voxels[3], double h);

/* For further checks of a section's items: returns E_CHECKPOINT with a message about item i. */
status section_refuse(const struct checkpoint *c, const char *section, size_t i, const char *format, ...)
    PRINTF_LIKE(4, 5);

/* Checks that n ids are unique and below `bound`, and adds them to *ids, which must be empty. */
MUST_USE status section_check_ids(const struct checkpoint *c, const char *section, const uint32_t *id,
                                  size_t n, uint64_t bound, struct idset *ids);

/* Reads the ledger and checks that start = rock + deposit + fallen + left and that each is at most SECTION_COUNT_MAX. */
MUST_USE status section_get_ledger(const struct checkpoint *c, struct ledger *out);

/* Saves the model, voxels, spacing and number of strata, and checks that a job has the same. E_CHECKPOINT, with what differs. */
MUST_USE status section_add_domain(struct checkpoint *c, const struct job *job);
MUST_USE status section_check_domain(const struct checkpoint *c, const struct job *job);

/* The number of voxels and their size, m, that a checkpoint says it has. */
MUST_USE status section_get_spacing(const struct checkpoint *c, int voxels[3], double *h);

#endif
