/* Sun, sky and haze of a scene. Radiance is scene-linear times DAYLIGHT_SCALE: POV-Ray clips its pictures at 1, and the tone curve
 * (render/develop.h) needs the values above white. */
#ifndef HOODOO_DAYLIGHT_H
#define HOODOO_DAYLIGHT_H

#include "field/light.h"
#include "render/view.h"
#include "text/text.h"

#define DAYLIGHT_SCALE 0.25

/* Adds the declarations that textures refer to (Ambient). Call before the textures are added. */
void daylight_begin(const struct light *light, struct text *out);

/* Adds the sun, `n` lights that together emit the light of the whole sky, haze, and the visible sky. `soft`: the sun is a disc and
 * casts soft shadows. */
void daylight_write(const struct light *light, const struct view *view, int n, bool soft, struct text *out);

#endif
