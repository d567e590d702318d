/* Lines over a picture that show the parts of a job other than rock: domain, wind, streams, paint, edits, tools and cameras. Each kind has a
 * colour, and each object a line of text. */
#ifndef HOODOO_LOOK_GIZMOS_H
#define HOODOO_LOOK_GIZMOS_H

#include "base/choice.h"
#include "field/field.h"
#include "look/shot.h"
#include "text/text.h"

#define GIZMOS_CHOICE (GIZMOS_NOW, "now")(GIZMOS_ALL, "all")(GIZMOS_NONE, "none")
enum gizmos { CHOICE_CONSTANTS(GIZMOS_CHOICE) };

/* Draws into `shot`. `which`: GIZMOS_NOW omits edits and tools of other frames. `own`: the camera of the picture, which is not drawn. `cut`: its outline is drawn. Adds a
 * line to `said` for each object: its colour, its key and a short description. Shapes without an outline (meshes, images) are described but
 * not drawn. */
void gizmos_draw(const struct job *job, int frame, enum gizmos which, const struct job_camera *own,
                 const struct field_cut *cut, struct shot *s, struct text *said);

#endif
