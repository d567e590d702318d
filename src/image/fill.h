/* Fills pixels without a value smoothly from the pixels around them. */
#ifndef HOODOO_IMAGE_FILL_H
#define HOODOO_IMAGE_FILL_H

#include <stddef.h>

#include "base/status.h"

/* Replaces the NaNs of value[height][width] by smooth values, the same in each run; all other values remain. At least one value
 * must not be NaN. E_MEMORY. */
MUST_USE status image_fill(size_t width, size_t height, float *value);

#endif
