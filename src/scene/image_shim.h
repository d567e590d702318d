/* OpenImageIO's door: one image's first channel. It is in hoodoo-read-image alone; ask through image_read(). */
#ifndef HOODOO_IMAGE_SHIM_H
#define HOODOO_IMAGE_SHIM_H

#include <stddef.h>

#include "base/status.h"

#ifdef __cplusplus
extern "C" {
#endif

/* As image_read(); dimensions are checked against max_pixels before anything is decoded. */
MUST_USE status image_decode(const char *path, size_t max_pixels, size_t *width, size_t *height,
                             float **value);

#ifdef __cplusplus
}
#endif
#endif
