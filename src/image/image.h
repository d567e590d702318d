/* Pictures from anywhere, as numbers: decoded by hoodoo-read-image (reader/reader.h), so that a hostile file costs an error
 * message and nothing else.
 *
 * The file is asked what its pixels mean, and the job may say otherwise (PIXELS in job/keys.def):
 *
 * Picture    The display window of an EXR; what lies outside of its data window is black. Turned as the file's orientation says.
 * Values     Integers are 0..1 or as they are stored, with all their bits; floats are what the file holds. Never converted by
 *            colour spaces, except where `channel` is luminance, which is a sum of light.
 * No data    NaN, infinite, what the file names (GDAL_NODATA, a mask), what the job names, and heights under an alpha of 0.
 * Map        Pixel size and place of GeoTIFF.
 */
#ifndef HOODOO_IMAGE_H
#define HOODOO_IMAGE_H

#include <stdbool.h>
#include <stddef.h>

#include "base/status.h"
#include "job/job.h"

/* Images of more pixels are refused before they are decoded: 16384 x 16384. */
#define IMAGE_MAX_PIXELS ((size_t)1 << 28)

/* The choices of PIXELS. */
enum image_nodata { IMAGE_REFUSE, IMAGE_EMPTY, IMAGE_FILL };
enum image_alpha { IMAGE_COVERAGE, IMAGE_IGNORE };

/* What 1 is: white of integers; 1 as it is stored, or as the file says that it is scaled; or a metre, likewise. */
enum image_values { IMAGE_UNIT, IMAGE_STORED, IMAGE_METRES };

struct image_wish {
    const char *file, *channel, *part, *nodata_value; /* "" or NULL: as the file says */
    int nodata, alpha;
    const double *size_px; /* [2] */
    bool height;           /* else a mask: 0 is nothing */
    enum image_values values;
    double scale, offset; /* values become offset + scale * value */
};

/* Of a job's section that has PIXELS: 0..1. */
#define IMAGE_WISH(job)                                                                                      \
    ((struct image_wish){.file = (job)->file,                                                                \
                         .channel = (job)->channel,                                                          \
                         .part = (job)->part,                                                                \
                         .nodata_value = (job)->nodata_value,                                                \
                         .nodata = (job)->nodata,                                                            \
                         .alpha = (job)->alpha,                                                              \
                         .size_px = (job)->size_px,                                                          \
                         .scale = 1})

enum image_map { IMAGE_NO_MAP, IMAGE_MAP_METRES, IMAGE_MAP_DEGREES, IMAGE_MAP_TURNED };

struct image {
    size_t width, height;
    float *value; /* top row first */
    unsigned char *
        has; /* of heights with nodata: empty, if some pixels have no value: 1 where there is one; else NULL. What has none
                           is filled from around it all the same */
    enum image_map map;
    bool map_named; /* the file names the map's system of coordinates; else metres are a guess */
    double pixel[2],
        corner[2]; /* m, with IMAGE_MAP_METRES: of a pixel; where the left bottom corner is on the map */
};

/* *out is freed with image_free(). E_INPUT names the file: missing, unreadable, too large, with pixels that have no value and nodata:
 * refuse, or its decoder crashed or ran away. E_USAGE: the job asks for what the file has not. */
MUST_USE status image_read(const struct image_wish *wish, struct image *out);
void image_free(struct image *image);

/* Says something of a file in the log, once however often it is read. */
void image_say(bool warn, const char *file, const char *what);

#endif
