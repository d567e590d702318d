/* A frame's surface as a POV-Ray scene, complete in one text. */
#ifndef HOODOO_POVRAY_H
#define HOODOO_POVRAY_H

#include "base/choice.h"
#include "base/text.h"
#include "field/camera.h"
#include "piles/piles.h"
#include "render/show.h"
#include "render/view.h"
#include "vdb/vdb.h"

#define PRESET_CHOICE (PRESET_DRAFT, "draft")(PRESET_PREVIEW, "preview")(PRESET_FINAL, "final")
enum preset { CHOICE_CONSTANTS(PRESET_CHOICE) };

/* Rocks in piles: the tile's shapes, and where they lie. */
struct scene_rocks {
    const struct pile_tile *tile;
    const struct rock *at; /* P, and in `layer` which of the tile */
};

/* The values the mesh comes with, 0 where a job has none, if the rock is shown as it looks; else it comes with the value
 * that is shown alone. */
enum { SCENE_VEGETATION, SCENE_DEPOSIT, SCENE_BEDROCK, SCENE_SAND, SCENE_VALUES };
extern const enum value_id scene_values[SCENE_VALUES];

struct scene {
    const struct job *job;
    int frame;
    const struct vdb_mesh *mesh;
    enum value_id show; /* VALUE_NONE: as it looks, in the sun; else a value as colour, in even light */
    struct show_range range;
    struct scene_rocks rocks; /* tile NULL: none */
    struct view view;
    bool figure;                 /* somebody stands there */
    const struct camera *camera; /* one a view: povray's Declare=View=2 takes the third */
    size_t n_cameras;            /* >= 1 */
    enum preset preset;
    const char *file; /* what the scene will be called, without folders: for the command in its first lines */
};

/* How often its mesh's triangles are to be cut in four (render/refine.h). */
int scene_cuts(const struct scene *s);

/* The scene's text added to `out`. E_INPUT if the mesh has no triangles: there is nothing to show. */
MUST_USE status scene_write(const struct scene *s, struct text *out);

#endif
