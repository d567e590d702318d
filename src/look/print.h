/* A shot as a PNG, with the strip, the scale bar and the legend that previews have. */
#ifndef HOODOO_LOOK_PRINT_H
#define HOODOO_LOOK_PRINT_H

#include "look/shot.h"
#include "render/slate.h"

/* Without anything to draw, libpng alone makes it; else oiiotool does, with files of its own for a moment in `folder`. *out is freed with
 * free(). E_INPUT: oiiotool is not installed. E_OUTPUT: `folder` cannot be written. */
MUST_USE status print_picture(const struct shot *shot, const struct slate *slate, const char *folder,
                              void **out, size_t *n);

#endif
