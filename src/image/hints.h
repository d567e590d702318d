/* Metadata about pixels that OpenImageIO does not report: the TIFF tags of GDAL and GeoTIFF, and PNG's eXIf chunk. Linked into
 * hoodoo-read-image only. */
#ifndef HOODOO_IMAGE_HINTS_H
#define HOODOO_IMAGE_HINTS_H

#include <stdbool.h>
#include <stddef.h>

#include "base/status.h"

#ifdef __cplusplus
extern "C" {
#endif

struct image_hints {
    bool has_nodata, has_scale;
    bool damaged_scale;   /* a scale or offset is present but not a number */
    double nodata;        /* as stored */
    double scale, offset; /* a value is offset + scale * stored */
    double height_unit;   /* m; 0: not stated */
    int mask;             /* the part that is this part's mask, or -1 */
    bool next_is_related; /* the next part is its mask or a smaller copy of it */
    int orientation;      /* EXIF; 0: not stated */
    int map;              /* enum image_map */
    bool has_system;      /* the file names a projected coordinate system, in metres or feet */
    double pixel[2];      /* m, to the right and down; negative: mirrored */
    double corner[2];     /* map coordinates of the first stored pixel's outer corner, m */
};

/* The metadata of one channel of one part. Metadata that cannot be read counts as absent. */
struct image_hints image_hints_read(const char *path, int part, int channel);

/* The orientation in n bytes of EXIF, a small TIFF whose tag 274 it is; 0: none. */
int image_exif_orientation(const unsigned char *exif, size_t n);

#ifdef __cplusplus
}
#endif
#endif
