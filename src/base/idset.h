/* A set of 32-bit numbers: a bit for each, 65,536 to a leaf; leaves that hold none take no memory. */
#ifndef HOODOO_IDSET_H
#define HOODOO_IDSET_H

#include <stdbool.h>
#include <stdint.h>

#include "base/status.h"

struct idset {
    uint64_t **leaf; /* [65536] */
};

/* {0} is the empty set, and idset_free() makes it that. */
void idset_free(struct idset *s);

/* *added: it was not in the set before. E_MEMORY. */
MUST_USE status idset_add(struct idset *s, uint32_t id, bool *added);

/* Takes it out; false if it was not in the set. */
bool idset_take(struct idset *s, uint32_t id);

#endif
