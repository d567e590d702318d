/* The attitude of beds (geology/attitude.h) as scene text. Declares the function Pile, which gives the height of a place within the pile of
 * beds (m); the transformation Lie, which tilts level laminae like the beds, without folds and faults; and Bottom and Height, the range of
 * the pile inside the job's box. */
#ifndef HOODOO_PILE_H
#define HOODOO_PILE_H

#include "job/job.h"
#include "text/text.h"

void pile_write(const struct job *job, struct text *out);

#endif
