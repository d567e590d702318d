/* PNG files (libpng): checks that they are complete, and stores the options they were made with as text under the keyword "hoodoo". */
#ifndef HOODOO_PNG_H
#define HOODOO_PNG_H

#include <stddef.h>

#include "base/status.h"

/* *out (to be freed with free()): the same picture with `tag` as its only text and without a date, so that equal pictures are equal
 * files. E_INPUT: truncated or damaged. */
MUST_USE status png_with_tag(const void *bytes, size_t n, const char *tag, void **out, size_t *n_out);

/* *out (to be freed with free()): a PNG of [height][width][3] sRGB bytes. */
MUST_USE status png_encode(const unsigned char *rgb, int width, int height, void **out, size_t *n_out);

/* The tag of a file; "" if the file has no tag, is not a PNG, or does not exist. */
enum { PNG_TAG = 400 };
void png_tag(const char *path, char out[PNG_TAG]);

#endif
