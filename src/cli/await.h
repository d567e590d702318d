/* Waiting for files that other machines wrote: tasks of a farm start right after those they wait for, on other nodes, and a shared disk may hide
 * for a while what these wrote (base/visible.h). Each function waits for that long at most, and says once that it does; without
 * HOODOO_DISK_DELAY none waits. What is still missing then is for the caller to report. */
#ifndef HOODOO_AWAIT_H
#define HOODOO_AWAIT_H

#include "render/picture.h"

/* folder_open(), after waiting until the frames in `frames` that the job has (step 0: its last one) are there with their files. */
MUST_USE status frames_folder(const char *root, struct frame_range frames, char name[256]);

/* The stills that the job's farm makes; the views of an orbit; the last still of each wedge. */
void await_stills(const struct preview *p);
void await_views(const struct preview *p, int frame, int views);
void await_wedges(const char *root, const struct job *const *wedge, size_t n);

#endif
