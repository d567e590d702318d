/* The sequence as one USD stage, root/NAME.usda: what a lighter opens.
 *
 * It names the frames that are done, so that a run that goes on can be looked at, and the meshes made of them. It is no frame's
 * file: no manifest lists it. The same frames give the same bytes.
 */
#ifndef HOODOO_STAGE_H
#define HOODOO_STAGE_H

#include "job/job.h"

/* Frames that were sound when they were read. */
struct stage_frame {
    int number;
    bool volumes, points, rocks; /* which files it lists */
};
struct stage_frames {
    struct stage_frame *frame; /* ascending */
    size_t n;
};
void stage_frames_free(struct stage_frames *frames);

/* From the manifests in `root` (frames of another job are left out) and the job's cameras; nothing while no
 * frame is done. `known`, or NULL for none: frames whose manifests need not be read again; those found are added to
 * it, and those that are gone leave it. A run keeps it, or else each of its checkpoints reads all manifests.
 * E_OUTPUT: it cannot be written. */
MUST_USE status stage_write(const struct job *job, uint64_t job_hash, const char *root,
                            struct stage_frames *known);

#endif
