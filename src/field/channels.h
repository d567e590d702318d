/* From what the device found under each pixel to a picture's channels. Inside field/ only. */
#ifndef HOODOO_CHANNELS_H
#define HOODOO_CHANNELS_H

#include "field/aov.h"
#include "field/mattes.h"
#include "job/job.h"
#include "particles/frame.h"

/* How many channels a picture of the job has at most: all layers it wants, and mattes. */
size_t aov_channel_count(const struct job *job);

/* Room for all of them; out->width and height are set. What is in `out` is the caller's to free, after failure too. */
MUST_USE status channels_begin(const struct job *job, struct aov_image *out);

/* What has been found under the pixels, in host memory. */
struct seen {
    float *hit, *facing, *color, *means; /* vec4 [n] */
    float *motion;                       /* vec4 [n], NULL: nothing moves */
    uint32_t *ids;                       /* [n][3] */
};

/* A value's channels: what the rays found, or what the device looks up for each pixel. Where hit's last is negative there is
 * no rock. Waits. */
MUST_USE status channels_add(struct gpu *gpu, struct aov *a, const struct job *job, const struct particles *p,
                             const struct aov_air *air, const struct seen *seen, enum value_id value,
                             struct aov_image *out);

MUST_USE status channels_mattes(const struct job *job, const struct mattes *mattes, struct aov_image *out);

#endif
