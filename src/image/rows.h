/* From rows of numbers as files store them to a picture: turned, cropped, scaled, and without what is no data. Decoders
 * (decode.h, plain.h) send their rows here. In hoodoo-read-image alone.
 *
 * Calling sequence   fill in what the decoder has to say; image_begin(); image_row() for each row; value is the caller's to free.
 */
#ifndef HOODOO_IMAGE_ROWS_H
#define HOODOO_IMAGE_ROWS_H

#include <stdbool.h>
#include <stddef.h>

#include "image/hints.h"
#include "image/parts.h"

#ifdef __cplusplus
extern "C" {
#endif

/* The picture under way. */
struct image_made {
    const char *const *word; /* the question, ASK_WORDS */
    const char *path, *open; /* for sentences; and where the bytes are */
    uint64_t max_pixels;
    struct image_hints hints;
    struct image_part part;
    float *value;
    char said[2000];
    /* set by who decodes, before image_begin() */
    int orientation;           /* of EXIF, 1 to 8; 0: none */
    uint64_t width, height;    /* of the picture, before it is turned */
    int64_t left, top;         /* where its first stored pixel is in it */
    double white;              /* of integers, as they are stored; 0: floats */
    bool whole, premultiplied; /* integers; alpha is in the values already */
    /* its own */
    double nodata[2];
    unsigned n_nodata;
    int64_t first, by_x, by_y; /* where a pixel goes */
    bool is_height, uses_alpha, drops_outside;
};

static inline bool image_asks(const struct image_made *made, enum image_word word, const char *what)
{
    const char *said = made->word[word];
    while (*said && *said == *what)
        said++, what++;
    return *said == *what;
}

/* E_INPUT: the picture is too large. E_USAGE: a nodata_value that is no number. */
MUST_USE status image_begin(struct image_made *made);

/* n numbers of row y, as they are stored, from column x on. alpha (0..1) and mask (0: no data) may be NULL. */
void image_row(struct image_made *made, int64_t x, int64_t y, size_t n, const double *stored,
               const double *alpha, const double *mask);

/* A line for the log. */
void image_note(struct image_made *made, bool warn, const char *format, ...) PRINTF_LIKE(3, 4);

#ifdef __cplusplus
}
#endif
#endif
