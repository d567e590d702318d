/* PNG files (libpng): is one whole, and how was it made? The latter stands in them as text under the keyword "hoodoo". */
#ifndef HOODOO_PNG_H
#define HOODOO_PNG_H

#include <stddef.h>

#include "base/status.h"

/* The same picture with `tag` in it, in *out (freed with free()), and without other words and times: equal pictures are
 * equal files. E_INPUT: it is cut short or damaged. */
MUST_USE status png_with_tag(const void *bytes, size_t n, const char *tag, void **out, size_t *n_out);

/* A picture of rows of sRGB, three bytes a pixel, in *out (freed with free()). */
MUST_USE status png_encode(const unsigned char *rgb, int width, int height, void **out, size_t *n_out);

/* The tag of a file; "" if it has none, or is no picture, or is not there. */
enum { PNG_TAG = 400 };
void png_tag(const char *path, char out[PNG_TAG]);

#endif
