/* Assembles the result image from rows of stored numbers: rotates, crops and scales, and detects no data. The decoders (decode.h,
 * plain.h) send their rows here. Linked into hoodoo-read-image only.
 *
 * Calling sequence   Fill in the decoder's fields; image_begin(); image_row() for each row. The caller frees value with free().
 */
#ifndef HOODOO_IMAGE_ROWS_H
#define HOODOO_IMAGE_ROWS_H

#include <stdbool.h>
#include <stddef.h>
#include <string.h>

#include "image/hints.h"
#include "image/protocol.h"

#ifdef __cplusplus
extern "C" {
#endif

/* One request being decoded. */
struct image_decoding {
    const char *const *argument;  /* [ASK_COUNT], the request */
    const char *path, *open_path; /* the file's name for messages; the file to open */
    uint64_t max_pixels;
    struct image_hints hints;
    struct image_answer answer;
    float *value;        /* [answer.height][answer.width], top row first */
    char messages[2000]; /* lines as protocol.h says */
    /* Set by the decoder before image_begin(): */
    int orientation;                /* EXIF, 1 to 8; 0: none */
    uint64_t width, height;         /* of the display window, before rotation */
    int64_t left, top;              /* position of the first stored pixel in the display window */
    double white;                   /* the stored value of white, of integers; 0: floats */
    bool is_integer, premultiplied; /* the values are already multiplied by alpha */
    /* Private to rows.c: */
    double nodata[2];
    unsigned n_nodata;
    int64_t first, by_x, by_y; /* pixel (x, y) goes to value[first + x * by_x + y * by_y] */
    bool is_height, uses_alpha, drops_outside;
};

/* Is this argument of the request `what`? */
static inline bool image_argument_is(const struct image_decoding *made, enum image_argument which,
                                     const char *what)
{
    return strcmp(made->argument[which], what) == 0;
}

/* Allocates value. E_INPUT: the picture is too large, or its scale is damaged. E_USAGE: nodata_value is not a number. E_MEMORY. */
MUST_USE status image_begin(struct image_decoding *made);

/* Adds stored[n] of row y from column x on, of the stored picture. alpha[n] (0..1) and mask[n] (0: no data) may be NULL. */
void image_row(struct image_decoding *made, int64_t x, int64_t y, size_t n, const double *stored,
               const double *alpha, const double *mask);

/* Adds a message about the file, for hoodoo's log. */
void image_note(struct image_decoding *made, bool warn, const char *format, ...) PRINTF_LIKE(3, 4);

#ifdef __cplusplus
}
#endif
#endif
