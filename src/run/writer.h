/* Writes frames and checkpoints behind the simulation: one thread, which holds one item.
 *
 * Order     Files appear in the order given: a frame's files, its manifest last, then the checkpoint taken
 *           after it.
 * Memory    writer_frame() waits while an item is written, so that a slow disk slows the run and nothing
 *           else.
 * Errors    The first error stops the writer; it is returned by the next call, and by writer_finish().
 */
#ifndef HOODOO_WRITER_H
#define HOODOO_WRITER_H

#include <stdbool.h>

#include "checkpoint/checkpoint.h"
#include "job/job.h"
#include "particles/frame.h"

struct writer;

/* `job` and `root` outlive the writer. `alone`: it is waited for, for want of room for what else is made meanwhile. */
MUST_USE status writer_create(const struct job *job, uint64_t job_hash, const char *root, bool alone,
                              struct writer **out);

/* Takes the frame over, whatever comes back. */
MUST_USE status writer_frame(struct writer *w, struct frame *frame);

/* Takes the checkpoint over, whatever comes back. */
MUST_USE status writer_checkpoint(struct writer *w, struct checkpoint *checkpoint);

/* Waits for all that is queued, and ends. NULL is fine. */
MUST_USE status writer_finish(struct writer **w);

/* The files of one frame, at once: what the thread does. With "" for a root they are made in memory, and dropped. */
MUST_USE status frame_write(const struct job *job, uint64_t job_hash, const char *root,
                            const struct frame *frame);

#endif
