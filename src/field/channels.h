/* Makes an image's channels from what the rays have hit. Private to src/field. */
#ifndef HOODOO_CHANNELS_H
#define HOODOO_CHANNELS_H

#include "field/aov.h"
#include "field/mattes.h"
#include "job/job.h"
#include "particles/frame.h"

/* The largest number of channels of an image of the job: all its layers, and mattes. */
size_t aov_channel_count(const struct job *job);

/* Allocates all channels; out->width and height are set. The caller frees *out with aov_image_free(), also on error. E_MEMORY. */
MUST_USE status channels_begin(const struct job *job, struct aov_image *out);

/* What the rays have hit, in host memory. */
struct hits {
    float *hit, *facing, *color, *means; /* vec4 [n] */
    float *motion;                       /* vec4 [n]; NULL: nothing moves */
    uint32_t *ids;                       /* [n][3] */
};

/* Adds a value's channels, from the hits or by a lookup on the device. Where hit.w is negative there is no rock. Waits for the device. */
MUST_USE status channels_add(struct gpu *gpu, struct aov *a, const struct job *job, const struct particles *p,
                             const struct aov_air *air, const struct hits *hits, enum value_id value,
                             struct aov_image *out);

/* Adds the mattes' channels and attributes. */
MUST_USE status channels_mattes(const struct job *job, const struct mattes *mattes, struct aov_image *out);

#endif
