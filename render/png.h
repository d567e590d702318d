/* Just enough of PNG: is a file whole, and how was it made? The latter stands in a text chunk right behind the header, under
 * the keyword "hoodoo". */
#ifndef HOODOO_PNG_H
#define HOODOO_PNG_H

#include <stdbool.h>
#include <stddef.h>

#include "base/status.h"

/* It begins as a PNG with its header and ends with its end chunk. */
bool png_whole(const void *bytes, size_t n);

/* The same picture with `tag` in it, in *out (freed with free()), and without other words and times: equal pictures are
 * equal files. `bytes` is whole. */
MUST_USE status png_with_tag(const void *bytes, size_t n, const char *tag, void **out, size_t *n_out);

/* The tag of a file; "" if it has none or is not there. */
enum { PNG_TAG = 400 };
void png_tag(const char *path, char out[PNG_TAG]);

#endif
