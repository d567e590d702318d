/* Sun, sky and haze of a scene. Light is scene-linear times DAYLIGHT_SCALE, so that POV-Ray, whose pictures end at 1, leaves room above
 * white for the view (render/develop.h). */
#ifndef HOODOO_DAYLIGHT_H
#define HOODOO_DAYLIGHT_H

#include "base/text.h"
#include "field/light.h"
#include "render/view.h"

#define DAYLIGHT_SCALE 0.25

/* Adds what textures need (Ambient), before them. */
void daylight_begin(const struct light *light, struct text *out);

/* Adds the sun, `n` lights that together send what the whole dome does, haze and the visible sky. `soft`: the sun is a disc. */
void daylight_write(const struct light *light, const struct view *view, int n, bool soft, struct text *out);

#endif
