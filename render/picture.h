/* Pictures of frames, through POV-Ray: each whole under its name, or absent. */
#ifndef HOODOO_PICTURE_H
#define HOODOO_PICTURE_H

#include <stdbool.h>

#include "job/job.h"
#include "render/child.h"
#include "render/povray.h"

/* What is asked for. */
struct preview {
    const char *root;
    const struct job *job;
    struct children children;
    enum preset preset;
    int width, height;  /* 0: the preset's */
    const char *camera; /* of the job, or NULL: its first, or an orbit if it has none */
    bool keep_scenes;
};

/* preview/NAME.FRAME.png. Starts it (children_wait() ends it), or skips it if it is newer than the frame's
 * volumes. */
MUST_USE status picture_still(struct preview *p, int frame);

/* turntable/NAME.FRAME.000.png and so on: `views` of a full orbit. Waits. */
MUST_USE status picture_orbit(struct preview *p, int frame, int views);

/* Their paths, relative to root. */
void picture_still_path(const struct preview *p, int frame, char out[512]);
void picture_view_path(const struct preview *p, int frame, int view, char out[512]);

/* Is root/`path` there, and no older than root/`source`? */
bool picture_current(const struct preview *p, const char *path, const char *source);

#endif
