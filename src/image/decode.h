/* Decodes with OpenImageIO. Linked into hoodoo-read-image only; other code calls image_read(). */
#ifndef HOODOO_IMAGE_DECODE_H
#define HOODOO_IMAGE_DECODE_H

#include "base/status.h"
#include "image/rows.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Decodes made->open_path into made->value. E_INPUT: not an image, or damaged. E_USAGE: it has no such part or channel. */
MUST_USE status image_decode(struct image_decoding *made);

#ifdef __cplusplus
}
#endif
#endif
