/* The sequence as one USD stage, root/NAME.usda: what a lighter opens.
 *
 * It names the frames that are done, so that a run that goes on can be looked at, and is no frame's file: no
 * manifest lists it. The same frames give the same bytes.
 */
#ifndef HOODOO_STAGE_H
#define HOODOO_STAGE_H

#include "job/job.h"

/* From the manifests in `root` (frames of another job are left out) and the job's cameras; nothing while no
 * frame is done. E_OUTPUT: it cannot be written. */
MUST_USE status stage_write(const struct job *job, uint64_t job_hash, const char *root);

#endif
