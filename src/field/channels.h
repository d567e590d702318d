/* From what the device found under each pixel to a picture's channels. Inside field/ only. */
#ifndef HOODOO_CHANNELS_H
#define HOODOO_CHANNELS_H

#include "field/mattes.h"
#include "job/job.h"
#include "particles/frame.h"

/* The vectors that kernels leave for each pixel, vec4 [n_pixels]. */
enum { FROM_HIT, FROM_FACING, FROM_COLOR, FROM_FIELDS, FROM_WEATHER, FROM_MOTION, AOV_SOURCES };

/* How many channels a picture of the job has at most: all layers it wants, and mattes. */
size_t aov_channel_count(const struct job *job);

/* A source that is NULL has no layers; there must be a FROM_HIT and a FROM_COLOR.
 *
 * The job's layers as planes of out->memory, in the files' axes. `ids` has three words a pixel: layer, phase,
 * particle. Mattes may be NULL. out->width and height are set; the rest is the caller's to free on failure. */
MUST_USE status aov_channels(const struct job *job, float *const source[AOV_SOURCES], const uint32_t *ids,
                             const struct mattes *mattes, struct aov_image *out);

#endif
