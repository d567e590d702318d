/* What hoodoo and hoodoo-read-image exchange (reader/protocol.h), whose only kind is "image".
 *
 * Request   Text arguments, in the order of enum image_argument.
 * Answer    Three parts: struct image_answer; messages about the file, one a line, which begin with 'i' (information) or 'w'
 *           (warning); and the values, float[height][width], top row first, NaN where a pixel has no value.
 */
#ifndef HOODOO_IMAGE_PROTOCOL_H
#define HOODOO_IMAGE_PROTOCOL_H

#include <stdint.h>

enum image_argument {
    ASK_FORM, /* format: "file": as its content says; "r16", "r32": raw values; "tiff": the bytes of READER_INPUT_PATH */
    ASK_CHANNEL,      /* see job/keys.def */
    ASK_PART,         /* the same */
    ASK_NODATA_VALUE, /* the same */
    ASK_ALPHA,        /* "coverage", "ignore" */
    ASK_OUTSIDE,      /* pixels outside of the data window: "black", "none" (without a value) */
    ASK_USE,          /* "height", "mask" */
    ASK_VALUES,       /* "unit", "stored", "metres": enum image_values */
    ASK_SCALE,        /* the result is offset + scale * value */
    ASK_OFFSET,
    ASK_WIDTH, /* of raw values; 0: a square */
    ASK_HEIGHT,
    ASK_COUNT
};

/* Why a pixel has no value. */
enum image_missing_why { WHY_NOT_FINITE, WHY_FILE, WHY_JOB, WHY_ALPHA, WHY_MASK };

struct image_answer {
    uint64_t width, height;
    uint64_t n_missing, n_outside; /* pixels without a value; pixels outside of the data window */
    uint64_t first_x, first_y;     /* the first pixel without a value, by rows from the top left */
    double first_value;            /* its stored value */
    double factor, offset;         /* the result is offset + factor * stored */
    double pixel[2], corner[2];    /* m: see struct image */
    uint32_t named;                /* 1: the file names a coordinate system */
    uint32_t why, map;             /* enum image_missing_why of the first; enum image_map */
};

#endif
