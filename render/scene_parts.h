/* The .inc files beside this, embedded: lines of POV-Ray scene text, the last NULL. */
#ifndef HOODOO_SCENE_PARTS_H
#define HOODOO_SCENE_PARTS_H

#include <stddef.h>

extern const char *const scene_camera[];    /* lens, and directions seen from it */
extern const char *const scene_light[];     /* sun, skylight */
extern const char *const scene_sky[];       /* sky, haze, sand */
extern const char *const scene_sandstone[]; /* the rock's texture */
extern const char *const scene_terrain[];   /* textures of ground and rubble, for model arches */
extern const char *const scene_heat[];      /* even light and a plain ground, for values as colours */
extern const char *const scene_scree[];     /* textures of deposits and of plants on them */

#endif
