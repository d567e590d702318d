/* How beds lie (geology/attitude.h), as scene text: the function Pile, a place's height in the pile of beds (m), the transformation Lie, by
 * which level laminae come to lie like them but for folds and faults, and Bottom and Height, what the job's box spans of the pile. */
#ifndef HOODOO_PILE_H
#define HOODOO_PILE_H

#include "base/text.h"
#include "job/job.h"

void pile_write(const struct job *job, struct text *out);

#endif
