/* Decoders of raw values and of grey PGM, of which OpenImageIO 2.4 reads some 16-bit values as one less than stored. Linked into
 * hoodoo-read-image only. */
#ifndef HOODOO_IMAGE_PLAIN_H
#define HOODOO_IMAGE_PLAIN_H

#include <stdbool.h>

#include "base/status.h"
#include "image/rows.h"

/* Is the file a binary grey PGM (P5)? */
bool image_is_pgm(const char *path);

/* Decode made->open_path into made->value. E_INPUT: the file is truncated or damaged. E_USAGE: its size does not match size_px, or a
 * channel or part that it does not have. */
MUST_USE status image_decode_pgm(struct image_decoding *made);
MUST_USE status image_decode_raw(struct image_decoding *made);

#endif
