/* Colours of strata and materials: those of the job, or default colours by index. */
#ifndef HOODOO_PALETTE_H
#define HOODOO_PALETTE_H

#include "job/job.h"

/* Linear Rec. 709, 0..1. */
void palette_color(const struct job *job, size_t layer, float rgb[3]);

/* The number of colours: the strata, and with model arches also sand, rock, water and the job's further materials. */
size_t palette_size(const struct job *job);

#endif
