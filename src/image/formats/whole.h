/* Decodes PNG and JPEG, whose libraries report errors by longjmp(), in C. */
#ifndef HOODOO_IMAGE_FORMATS_WHOLE_H
#define HOODOO_IMAGE_FORMATS_WHOLE_H

#include <stdbool.h>
#include <stddef.h>

#ifdef __cplusplus
extern "C" {
#endif

struct whole {
    int width, height, channels, bytes; /* bytes of a number: 1 or 2 */
    double gamma;                       /* of PNG's gAMA; 0: sRGB */
    int orientation;                    /* EXIF; 0: none */
    unsigned char *data; /* [height][width][channels], in this machine's byte order; freed with free() */
    char error[256];
};

/* Set *out: the head alone, or with `data`. On failure they return false, `error` says why and `data` is NULL. PNG: palettes become
 * colours, fewer than 8 bits become 8, a transparent colour becomes alpha. */
bool whole_png(const char *path, bool with_data, struct whole *out);
bool whole_jpeg(const char *path, bool with_data, struct whole *out);

#ifdef __cplusplus
}
#endif
#endif
