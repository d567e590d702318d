/* A frame's surface as a self-contained POV-Ray scene. */
#ifndef HOODOO_POVRAY_H
#define HOODOO_POVRAY_H

#include "base/choice.h"
#include "field/camera.h"
#include "piles/piles.h"
#include "render/show.h"
#include "render/view.h"
#include "text/text.h"
#include "vdb/vdb.h"

#define PRESET_CHOICE (PRESET_DRAFT, "draft")(PRESET_PREVIEW, "preview")(PRESET_FINAL, "final")
enum preset { CHOICE_CONSTANTS(PRESET_CHOICE) };

/* Rocks of piles: the shapes of the tile, and the places of the rocks. */
struct scene_rocks {
    const struct pile_tile *tile;
    const struct rock *at; /* P, and in `layer` the index of the shape in the tile */
};

/* The values per vertex of a mesh that is shown as rock, in this order; 0 where a job has no such value. A mesh that is shown as a value has
 * this value alone. */
enum { SCENE_VEGETATION, SCENE_DEPOSIT, SCENE_BEDROCK, SCENE_SAND, SCENE_VALUES };
extern const enum value_id scene_values[SCENE_VALUES];

struct scene {
    const struct job *job;
    int frame;
    const struct vdb_mesh *mesh;
    enum value_id show; /* VALUE_NONE: rock in sunlight; otherwise a value as colour, in even light */
    struct show_range range;
    struct scene_rocks rocks; /* tile NULL: none */
    struct view view;
    bool figure;                 /* a person stands in the scene */
    const struct camera *camera; /* one per view; povray's Declare=View=2 selects the third */
    size_t n_cameras;            /* >= 1 */
    enum preset preset;
    const char *file; /* file name of the scene without folders, for the command in its first lines */
};

/* How often the triangles of the mesh should be divided into four (render/refine.h). */
int scene_cuts(const struct scene *s);

/* Adds the text of the scene to `out`. E_INPUT: the mesh has no triangles. E_MEMORY. */
MUST_USE status scene_write(const struct scene *s, struct text *out);

#endif
