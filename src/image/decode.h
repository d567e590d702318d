/* OpenImageIO's door. It is in hoodoo-read-image alone; ask through image_read(). */
#ifndef HOODOO_IMAGE_DECODE_H
#define HOODOO_IMAGE_DECODE_H

#include "base/status.h"
#include "image/rows.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Decodes made->open. E_INPUT: it is no image, or damaged. E_USAGE: it has no such part or channel. */
MUST_USE status image_decode(struct image_made *made);

#ifdef __cplusplus
}
#endif
#endif
