/* Pixels without a value, from those around them. */
#ifndef HOODOO_IMAGE_FILL_H
#define HOODOO_IMAGE_FILL_H

#include <stddef.h>

#include "base/status.h"

/* Puts smooth values where there is NaN, the same ones each time; all others stay as they are. At least one is not NaN.
 * E_MEMORY. */
MUST_USE status image_fill(size_t width, size_t height, float *value);

#endif
