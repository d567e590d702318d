/* A set of 32-bit numbers, stored as a bitmap in leaves of 65,536 bits; empty leaves are not allocated until needed. */
#ifndef HOODOO_IDSET_H
#define HOODOO_IDSET_H

#include <stdbool.h>
#include <stdint.h>

#include "base/status.h"

struct idset {
    uint64_t **leaf; /* [65536] */
};

/* Frees the memory and leaves the empty set, which is {0}. */
void idset_free(struct idset *s);

/* Sets *added to true if `id` was not in the set before. E_MEMORY. */
MUST_USE status idset_add(struct idset *s, uint32_t id, bool *added);

/* Removes `id`; returns false if it was not in the set. */
bool idset_remove(struct idset *s, uint32_t id);

#endif
