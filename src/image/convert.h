/* Files of heights that only GDAL reads, made into TIFF by its program gdal_translate, which runs under limits
 * (reader/translate.h). */
#ifndef HOODOO_IMAGE_CONVERT_H
#define HOODOO_IMAGE_CONVERT_H

#include <stddef.h>

#include "base/status.h"

struct converted {
    const char *form; /* as ASK_FORM of parts.h */
    void *bytes;      /* of the TIFF; NULL: the file is read as it is */
    size_t size;
};

/* By the end of the file's name. E_INPUT: gdal_translate is not installed, or fails. E_MEMORY. */
MUST_USE status image_convert(const char *file, struct converted *out);
void converted_free(struct converted *converted);

#endif
