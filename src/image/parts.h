/* What passes between hoodoo and hoodoo-read-image (reader/protocol.h), whose one kind is "image".
 *
 * Asked     in words, in the order of enum image_word.
 * Answered  struct image_part; what there is to say about the file, lines that begin with 'i' or 'w' (information, warning); and the
 *           values, floats, top row first, NaN where there is none.
 */
#ifndef HOODOO_IMAGE_PARTS_H
#define HOODOO_IMAGE_PARTS_H

#include <stdint.h>

enum image_word {
    ASK_FORM, /* of the bytes: "file": as they say; "r16", "r32": raw; "tiff": those that the reader is given beside the file */
    ASK_CHANNEL,      /* see job/keys.def */
    ASK_PART,         /* the same */
    ASK_NODATA_VALUE, /* the same */
    ASK_ALPHA,        /* "coverage", "ignore" */
    ASK_OUTSIDE,      /* of the data window: "black", "none" */
    ASK_USE,          /* "height", "mask" */
    ASK_VALUES,       /* "unit", "stored", "metres" */
    ASK_SCALE,        /* what comes of a value: offset + scale * value */
    ASK_OFFSET,
    ASK_WIDTH, /* of raw values; 0: of a square */
    ASK_HEIGHT,
    ASK_WORDS
};

/* Why a pixel has no value. */
enum image_why { WHY_NOT_FINITE, WHY_FILE, WHY_JOB, WHY_ALPHA, WHY_MASK };

struct image_part {
    uint64_t width, height;
    uint64_t n_missing, n_outside; /* pixels without a value; outside of the data window */
    uint64_t first_x, first_y;     /* of those without a value the first, from the top left */
    double first_value;            /* as it is stored */
    double factor, offset;         /* values are offset + factor * what is stored */
    double pixel[2], corner[2];    /* m: see struct image */
    uint32_t named;                /* 1: by a system of coordinates that the file names */
    uint32_t why, map;             /* enum image_why of the first; enum image_map */
};

#endif
