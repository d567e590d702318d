/* A shot as a PNG, with the strip, scale bar and legend of previews. */
#ifndef HOODOO_LOOK_PRINT_H
#define HOODOO_LOOK_PRINT_H

#include "look/shot.h"
#include "render/slate.h"

/* *out: a PNG of *n bytes, to be freed with free(). If there is a slate to draw, oiiotool draws it, with temporary files in `folder`.
 * E_INPUT: oiiotool is not installed. E_OUTPUT: `folder` cannot be written. */
MUST_USE status print_picture(const struct shot *shot, const struct slate *slate, const char *folder,
                              void **out, size_t *n);

#endif
