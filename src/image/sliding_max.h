/* Sliding maximum. */
#ifndef HOODOO_IMAGE_SLIDING_MAX_H
#define HOODOO_IMAGE_SLIDING_MAX_H

#include <stddef.h>

#include "base/status.h"

/* Replaces each value of field[height][width] by the largest within rx columns and ry rows of it. The time does not depend on rx and
 * ry. E_MEMORY. */
MUST_USE status sliding_max(size_t width, size_t height, size_t rx, size_t ry, float *field);

#endif
