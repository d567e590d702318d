/* What a job has besides rock, as lines over a picture: the domain, the wind, water's ways, paint, edits, tools, cameras. Each kind has its
 * colour, and a line of text says what is there. */
#ifndef HOODOO_LOOK_GIZMOS_H
#define HOODOO_LOOK_GIZMOS_H

#include "base/choice.h"
#include "base/text.h"
#include "look/shot.h"

#define GIZMOS_CHOICE (GIZMOS_NOW, "now")(GIZMOS_ALL, "all")(GIZMOS_NONE, "none")
enum gizmos { CHOICE_CONSTANTS(GIZMOS_CHOICE) };

/* `which`: GIZMOS_NOW leaves out the edits and tools of other frames. `own`: the camera that looks, which is not drawn. Adds a line to
 * `said` for each thing: its colour, its key, and in few words what it is. Shapes that have no outline of their own (meshes, pictures) are
 * said and not drawn. */
void gizmos_draw(const struct job *job, int frame, enum gizmos which, const struct job_camera *own,
                 struct shot *s, struct text *said);

#endif
