/* The .inc files of this folder, embedded as lines of POV-Ray scene text; the last line is NULL. */
#ifndef HOODOO_SCENE_PARTS_H
#define HOODOO_SCENE_PARTS_H

#include <stddef.h>

extern const char *const scene_camera[];    /* lens */
extern const char *const scene_sandstone[]; /* the rock's texture */
extern const char *const scene_ground[];    /* the ground and its textures */
extern const char *const scene_terrain[];   /* textures of terrain (model arches) */
extern const char *const scene_heat[];      /* even light and a plain ground, for values as colours */
extern const char *const scene_scree[];     /* textures of deposits and of the ground under plants */
extern const char *const scene_rubble[];    /* textures of stones */

#endif
