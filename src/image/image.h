/* Reads images as numbers: heights or masks. hoodoo-read-image (reader/reader.h) decodes them in a process of its own, so that a
 * hostile file causes an error message and nothing else.
 *
 * The file states what its pixels mean, and the job may override it (PIXELS in job/keys.def):
 *
 * Picture    An EXR's display window; pixels outside of its data window are black. Rotated as the file's orientation says.
 * Values     Integers become 0..1 or stay as stored, with all their bits; floats stay as stored. Values are never converted between
 *            colour spaces, except for `channel: luminance`, which is a weighted sum of linear light.
 * No data    NaN, infinity, values that the file (GDAL_NODATA, a mask) or the job declares as no data, and heights where alpha is 0.
 * Map        Pixel size and position of GeoTIFF.
 */
#ifndef HOODOO_IMAGE_H
#define HOODOO_IMAGE_H

#include <stdbool.h>
#include <stddef.h>

#include "base/status.h"
#include "job/job.h"

/* Larger images are refused before they are decoded: 16384 x 16384 pixels. */
#define IMAGE_MAX_PIXELS ((size_t)1 << 28)

/* The choices of PIXELS in job/keys.def. */
enum image_nodata { IMAGE_REFUSE, IMAGE_EMPTY, IMAGE_FILL };
enum image_alpha { IMAGE_COVERAGE, IMAGE_IGNORE };

/* The unit of values: the white of integers (floats as stored); stored values, after the file's own scale and offset; metres, also
 * after the file's unit of height. */
enum image_values { IMAGE_UNIT, IMAGE_STORED, IMAGE_METRES };

struct image_request {
    const char *file, *channel, *part, *nodata_value; /* "" or NULL: left to the file */
    int nodata, alpha;
    const double *size_px; /* [2]: width and height of raw values; NULL or 0: from the file */
    bool height;           /* heights; false: a mask, in which 0 means nothing */
    enum image_values values;
    double scale, offset; /* the result is offset + scale * value */
};

/* The request of a job section that has PIXELS, for values 0..1. */
#define IMAGE_REQUEST(job)                                                                                   \
    ((struct image_request){.file = (job)->file,                                                             \
                            .channel = (job)->channel,                                                       \
                            .part = (job)->part,                                                             \
                            .nodata_value = (job)->nodata_value,                                             \
                            .nodata = (job)->nodata,                                                         \
                            .alpha = (job)->alpha,                                                           \
                            .size_px = (job)->size_px,                                                       \
                            .scale = 1})

/* Whether the file has a position on a map: in metres, in degrees, or rotated against the map's axes. */
enum image_map { IMAGE_NO_MAP, IMAGE_MAP_METRES, IMAGE_MAP_DEGREES, IMAGE_MAP_TURNED };

struct image {
    size_t width, height;
    float *value; /* [height][width], top row first; filled smoothly where a pixel has no value */

    /* [height][width]: does the pixel have a value? NULL if all have; only for heights with nodata: empty. */
    unsigned char *has;

    enum image_map map;
    bool map_named;   /* the file names the map's coordinate system; else it is assumed to be in metres */
    double pixel[2];  /* m, with IMAGE_MAP_METRES: pixel size */
    double corner[2]; /* m, with IMAGE_MAP_METRES: map coordinates of the bottom left corner */
};

/* Free *out with image_free(). E_INPUT, with the file's name: it is missing, unreadable or too large, it has pixels without a value and
 * the request says IMAGE_REFUSE, or its decoder crashed or exceeded a limit. E_USAGE: the file has no such part, channel or size. */
MUST_USE status image_read(const struct image_request *request, struct image *out);

/* Takes and checks the answer of hoodoo-read-image to a request (image/protocol.h). Errors as above. */
struct reader_answer;
MUST_USE status image_take(const struct image_request *request, struct reader_answer *answer,
                           struct image *out);
void image_free(struct image *image);

/* Logs a message about a file, once per process however often the file is read. */
void image_log(bool warn, const char *file, const char *what);

#endif
