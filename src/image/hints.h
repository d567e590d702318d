/* What files say of their pixels beside what the decoders tell: TIFF's tags of GDAL and GeoTIFF, and PNG's eXIf. In
 * hoodoo-read-image alone. */
#ifndef HOODOO_IMAGE_HINTS_H
#define HOODOO_IMAGE_HINTS_H

#include <stdbool.h>

#include "base/status.h"

#ifdef __cplusplus
extern "C" {
#endif

struct image_hints {
    bool has_nodata, has_scale;
    bool damaged_scale;   /* it has some, which is no number */
    double nodata;        /* as it is stored */
    double scale, offset; /* values mean offset + scale * what is stored */
    double up;            /* m, the unit of heights; 0: not said */
    int mask;             /* the part that is its mask, or -1 */
    bool belongs;         /* the next part is its mask, or the same picture in small */
    int orientation;      /* of EXIF; 0: not said */
    int map;              /* enum image_map */
    bool has_system;      /* whose coordinates are in metres or feet by what it says */
    double pixel[2];      /* m, to the right and down; negative where the picture is mirrored */
    double corner[2];     /* m: of its first stored pixel */
};

/* Of part `part` of the file, and of that its channel `channel`. What cannot be read says nothing. */
struct image_hints image_hints_read(const char *path, int part, int channel);

#ifdef __cplusplus
}
#endif
#endif
