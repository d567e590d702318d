/* Files that are little more than their numbers: raw values, and grey PGM, of which OpenImageIO 2.4 reads some 16-bit values as one less.
 * In hoodoo-read-image alone. */
#ifndef HOODOO_IMAGE_PLAIN_H
#define HOODOO_IMAGE_PLAIN_H

#include <stdbool.h>

#include "base/status.h"
#include "image/rows.h"

/* Binary grey PGM? */
bool image_is_pgm(const char *path);

/* Decodes made->open. E_INPUT: it ends early, or has not the size that was said. */
MUST_USE status image_decode_pgm(struct image_made *made);
MUST_USE status image_decode_raw(struct image_made *made);

#endif
