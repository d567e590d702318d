/* The .inc files beside this, embedded: lines of POV-Ray scene text, the last NULL. */
#ifndef HOODOO_SCENE_PARTS_H
#define HOODOO_SCENE_PARTS_H

#include <stddef.h>

extern const char *const scene_light[];     /* lens, sun, skylight */
extern const char *const scene_sky[];       /* sky, haze, sand */
extern const char *const scene_sandstone[]; /* the rock's texture */
extern const char *const scene_terrain[];   /* textures of ground and rubble, for model arches */
extern const char *const scene_scree[];     /* textures of deposits and of plants on them */

#endif
