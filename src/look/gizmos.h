/* What a job has besides rock, as lines over a picture: the domain, the wind, water's ways, paint, edits, tools, cameras. Each kind has its
 * colour, and a line of text says what is there. */
#ifndef HOODOO_LOOK_GIZMOS_H
#define HOODOO_LOOK_GIZMOS_H

#include "base/text.h"
#include "look/shot.h"

/* `own`: the camera that looks, which is not drawn. Adds a line to `said` for each thing: its colour, its key, and in few words what it
 * is. Shapes that have no outline of their own (meshes, pictures, formulas without a box) are said and not drawn. */
void gizmos_draw(const struct job *job, int frame, const struct job_camera *own, struct shot *s,
                 struct text *said);

#endif
