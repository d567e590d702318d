/* Terrain files stacks/NAME.1001.stacks, which the shape `stacks` reads. FORMAT.md has the layout. */
#ifndef HOODOO_STACKS_FILE_H
#define HOODOO_STACKS_FILE_H

#include "stacks/stacks.h"

/* Encodes s; the caller frees *bytes. `solid`: the set of materials that never slide. E_MEMORY. */
MUST_USE status stacks_encode(const struct stacks *s, uint32_t solid, void **bytes, size_t *size);

/* Free *out with stacks_destroy(). E_INPUT: the file is missing, damaged or hostile. E_MEMORY. */
MUST_USE status stacks_read(const char *path, struct stacks *out, uint32_t *solid);

#endif
