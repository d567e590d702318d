/* The USD stage of a run, root/NAME.usda: the whole sequence as one file for other programs to open.
 *
 * It lists only completed frames and the meshes made from them, so it can be opened while a run is in progress. It does not belong to
 * any frame, and no manifest lists it. The same frames give the same bytes.
 */
#ifndef HOODOO_STAGE_H
#define HOODOO_STAGE_H

#include "job/job.h"

/* Frames whose manifests and files were sound when they were read. */
struct stage_frame {
    int number;
    bool volumes, points, rocks; /* the kinds of files that it has */
};
struct stage_frames {
    struct stage_frame *frame; /* ascending; owned, stage_frames_free() */
    size_t n;
};
void stage_frames_free(struct stage_frames *frames);

/* Writes the stage from the manifests in `root` and the job's cameras, sun and sky. Frames that `states` (job_states()) does not hold are
 * left out; NULL: all belong to the job. While no frame is done, nothing is written. `known` holds the frames found by the previous
 * call, whose manifests are not read again, and is updated; without it, each checkpoint of a run would read all manifests. NULL: this is
 * the last stage; all manifests and the records of meshes are read, and what cannot be read once is read again. E_INPUT, then: the
 * manifest of one of the job's frames cannot be read. E_OUTPUT: the file cannot be written. */
MUST_USE status stage_write(const struct job *job, const struct job_states *states, const char *root,
                            struct stage_frames *known);

#endif
