/* A shot as a PNG file, with the strip, the scale bar and the legend that previews have. */
#ifndef HOODOO_LOOK_PRINT_H
#define HOODOO_LOOK_PRINT_H

#include "look/shot.h"
#include "render/slate.h"

/* Without anything to draw, libpng alone writes it; else oiiotool draws. E_INPUT: that is not installed. E_OUTPUT: the file cannot be
 * written; what was there before stays. */
MUST_USE status print_picture(const struct shot *shot, const struct slate *slate, const char *path);

#endif
