/* Height files that only GDAL reads are converted to TIFF by its program gdal_translate, which runs under resource limits
 * (reader/translate.h). */
#ifndef HOODOO_IMAGE_CONVERT_H
#define HOODOO_IMAGE_CONVERT_H

#include <stddef.h>

#include "base/status.h"

struct converted {
    const char *form; /* value of ASK_FORM (protocol.h) */
    void *bytes;      /* the TIFF; NULL: read the file itself */
    size_t size;
};

/* Decides by the file name's extension; converts if necessary. Free *out with converted_free(). E_INPUT: gdal_translate is not
 * installed, fails or takes too long. E_MEMORY. */
MUST_USE status image_convert(const char *file, struct converted *out);
void converted_free(struct converted *converted);

#endif
