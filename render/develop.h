/* Tone mapping of previews: scene-linear radiance to sRGB.
 *
 * Curve    Per channel, the response of Naka and Rushton (1966), x^n / (x^n + s^n), with n = 1.3. It is nearly straight in the middle,
 *          compresses dark tones and rolls off highlights. Mid grey (0.18) is unchanged and 4 maps to white. sRGB encoding follows.
 * EXR      The layer rgba is scene-linear; this curve makes it look like the previews.
 */
#ifndef HOODOO_DEVELOP_H
#define HOODOO_DEVELOP_H

#include <stddef.h>

#include "base/status.h"

/* The curve alone, without sRGB encoding: linear radiance to 0..1. */
double develop_view(double linear);

/* A colour as the picture shows it: multiplied by `exposure`, through the curve, sRGB-encoded. */
void develop_color(const double linear[3], double exposure, unsigned char rgb[3]);

/* Converts a linear 16-bit PPM (P6), whose 65535 means scene-linear `white`, to an 8-bit sRGB PPM. Radiance is multiplied by
 * `exposure` first. In place; *n is the size in bytes before and after. E_INPUT: not such a picture, or truncated. */
MUST_USE status develop_ppm(void *bytes, size_t *n, double white, double exposure);

#endif
