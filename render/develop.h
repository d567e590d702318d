/* The view of a preview: scene-linear light as a picture to look at.
 *
 * Curve    Per channel, the response of Naka and Rushton (1966), x^n / (x^n + s^n): straight over most of its length, dark tones
 *          drawn in, highlights that go white softly. n is 1.3, mid grey (0.18) stays, and 4 is white. Then sRGB.
 * EXR      rgba of pictures is scene-linear: the same curve shows it as previews are shown.
 */
#ifndef HOODOO_DEVELOP_H
#define HOODOO_DEVELOP_H

#include <stddef.h>

#include "base/status.h"

/* The curve alone: 0..1, linear. */
double develop_view(double linear);

/* Of a colour, after `exposure`: as the picture has it, sRGB. */
void develop_color(const double linear[3], double exposure, unsigned char rgb[3]);

/* A linear 16-bit PPM (P6), whose 65535 is scene-linear `white`, becomes one of 8 bits in sRGB; *n changes with it. Light is
 * multiplied by `exposure` before. In place. E_INPUT: it is none, or cut short. */
MUST_USE status develop_ppm(void *bytes, size_t *n, double white, double exposure);

#endif
