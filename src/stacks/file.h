/* Terrain as a file: stacks/NAME.1001.stacks, which a scene's shape `stacks` reads.
 *
 * Layout (little endian)   magic "hoodoo.stck\0", version, n[2], materials, solid materials (a bit each),
 *                          layers in all, cell and quantum (double, m); counts; layers; XXH3 of all before.
 */
#ifndef HOODOO_STACKS_FILE_H
#define HOODOO_STACKS_FILE_H

#include "stacks/stacks.h"

/* In *bytes, freed with free(). `solid`: materials that never slide. */
MUST_USE status stacks_encode(const struct stacks *s, uint32_t solid, void **bytes, size_t *size);

/* E_INPUT if the file is missing, damaged or hostile. */
MUST_USE status stacks_read(const char *path, struct stacks *out, uint32_t *solid);

#endif
