/* A model's state as a checkpoint's sections. */
#ifndef HOODOO_SECTIONS_H
#define HOODOO_SECTIONS_H

#include "checkpoint/checkpoint.h"
#include "job/job.h"

/* Adds a section of n items; *data is its memory, to be filled. */
MUST_USE status section_add(struct checkpoint *c, const char *name, size_t item, size_t n, void **data);

/* E_CHECKPOINT if there is none of that name and item size, or n is not 0 and it has another number of items.
 */
MUST_USE status section_find(const struct checkpoint *c, const char *name, size_t item, size_t n,
                             const struct checkpoint_section **out);

/* What every model's checkpoint says of its domain: model, voxels, spacing and number of strata; and whether a job
 * has the same. E_CHECKPOINT says what differs. */
MUST_USE status section_add_domain(struct checkpoint *c, const struct job *job);
MUST_USE status section_check_domain(const struct checkpoint *c, const struct job *job);

#endif
