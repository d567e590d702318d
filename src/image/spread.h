/* The largest around each pixel. */
#ifndef HOODOO_IMAGE_SPREAD_H
#define HOODOO_IMAGE_SPREAD_H

#include <stddef.h>

#include "base/status.h"

/* Each value of the field becomes the largest of those up to rx columns and ry rows away. Its time does not depend on how far.
 * E_MEMORY. */
MUST_USE status spread_largest(size_t width, size_t height, size_t rx, size_t ry, float *field);

#endif
