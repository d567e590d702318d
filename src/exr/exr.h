/* OpenEXR files from C: one frame's AOVs. Written into memory, so that a full disk is the caller's to notice.
 */
#ifndef HOODOO_EXR_H
#define HOODOO_EXR_H

#include "base/status.h"
#include "base/text.h"
#include "particles/frame.h"

struct exr_options {
    int layout; /* AOV_LAYOUT_* */
    double fps;
    int frame;
    double years;
    uint64_t job_hash;
    const char *owner, *comments;
    const char *wedge; /* which values this wedge has; "" or NULL: none */
};

/* ZIP; float but for channels marked half; uint for ids. Standard attributes as DESIGN 2 lists them, and
 * hoodoo:*. *bytes is freed with free(). */
MUST_USE status exr_encode(const struct aov_image *image, const struct exr_options *options, void *bytes,
                           size_t *size);

/* Reads every pixel. E_INPUT if anything is missing or damaged. */
MUST_USE status exr_check(const char *path);

/* Parts, channels, size, compression and attributes as a JSON object's members. E_INPUT as above. */
MUST_USE status exr_describe(const char *path, struct text *out);

#endif
