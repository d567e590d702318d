/* Images from anywhere: decoded by hoodoo-read-image (reader/reader.h), so that a hostile file costs an error message and
 * nothing else.
 */
#ifndef HOODOO_IMAGE_H
#define HOODOO_IMAGE_H

#include <stddef.h>

#include "base/status.h"

/* Images of more pixels are refused before they are decoded: 16384 x 16384. */
#define IMAGE_MAX_PIXELS ((size_t)1 << 28)

/* The first channel, top row first, in *value (freed with free()). Integer images give 0..1, float ones what
 * they hold; no colour conversion. E_INPUT names the file: missing, unreadable, too large, or its decoder
 * crashed or ran away. */
MUST_USE status image_read(const char *path, size_t *width, size_t *height, float **value);

#endif
