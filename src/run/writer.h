/* Writes frames and checkpoints in a thread of its own while the simulation continues.
 *
 * Order     Files appear in the order of the calls: the files of a frame, then its manifest; a checkpoint is one file.
 * Memory    The writer holds one item. writer_frame() and writer_checkpoint() block while another item is being written, so a slow
 *           disk slows the run down instead of filling memory.
 * Errors    The first error stops the writer. The next call returns it, and so does writer_finish().
 */
#ifndef HOODOO_WRITER_H
#define HOODOO_WRITER_H

#include <stdbool.h>

#include "checkpoint/checkpoint.h"
#include "job/job.h"
#include "particles/frame.h"

struct writer;

/* `job`, `states` (job_states()) and `root` must outlive the writer. `blocking`: each call waits until its item is written, because memory does not hold a
 * second frame. */
MUST_USE status writer_create(const struct job *job, const struct job_states *states, const char *root,
                              bool blocking, struct writer **out);

/* Takes ownership of *frame, also on error. */
MUST_USE status writer_frame(struct writer *w, struct frame *frame);

/* Takes ownership of *checkpoint, also on error. */
MUST_USE status writer_checkpoint(struct writer *w, struct checkpoint *checkpoint);

/* Waits until everything is written, ends the thread and frees the writer. *w may be NULL. */
MUST_USE status writer_finish(struct writer **w);

/* Writes the files of one frame in the calling thread. If root is "", the files are encoded in memory and discarded. */
MUST_USE status frame_write(const struct job *job, const struct job_states *states, const char *root,
                            const struct frame *frame);

#endif
