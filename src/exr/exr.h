/* OpenEXR files of one frame's AOVs. Files are encoded in memory; the caller writes them, and so notices a full disk. */
#ifndef HOODOO_EXR_H
#define HOODOO_EXR_H

#include "base/status.h"
#include "particles/frame.h"
#include "text/text.h"

struct exr_options {
    int layout; /* AOV_LAYOUT_* */
    double fps;
    int frame;
    double years;
    uint64_t job_hash;
    const char *owner, *comments;
    const char *wedge; /* the values of this wedge; "" or NULL: the job has no wedges */
};

/* Encodes a picture with ZIP compression: uint channels for ids, half where the channel says so, float otherwise. Attributes are the
 * standard ones for cameras, colours and time, and hoodoo:*. `bytes` points to the pointer that receives the file, freed with free(). */
MUST_USE status exr_encode(const struct aov_image *image, const struct exr_options *options, void *bytes,
                           size_t *size);

/* Reads every pixel. E_INPUT if the file is missing or damaged. */
MUST_USE status exr_check(const char *path);

/* Adds parts, channels, size, compression and attributes to `out`, as members of a JSON object. E_INPUT as above. */
MUST_USE status exr_describe(const char *path, struct text *out);

#endif
