#include <errno.h>
#include <png.h>
#include <setjmp.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "image/formats/whole.h"

static void on_error(png_structp png, png_const_charp text)
{
    struct whole *out = png_get_error_ptr(png);
    snprintf(out->error, sizeof out->error, "%s", text);
    longjmp(png_jmpbuf(png), 1);
}

static void on_warning(png_structp png, png_const_charp text)
{
    (void)png;
    (void)text;
}

static void read_head(png_structp png, png_infop info, struct whole *out)
{
    int intent;
    double gamma = 0;
    png_read_info(png, info);
    png_set_expand(png);
    if (png_get_bit_depth(png, info) == 16)
        png_set_swap(png); /* this machine is little-endian */
    png_set_interlace_handling(png);
    png_read_update_info(png, info);
    out->width = (int)png_get_image_width(png, info);
    out->height = (int)png_get_image_height(png, info);
    out->channels = png_get_channels(png, info);
    out->bytes = png_get_bit_depth(png, info) == 16 ? 2 : 1;
    if (!png_get_sRGB(png, info, &intent) && png_get_gAMA(png, info, &gamma) && gamma > 0)
        out->gamma = 1 / gamma;
}

/* Rows are decoded in place; those of interlaced images in several passes. Returns false without memory. */
static bool read_data(png_structp png, png_infop info, struct whole *out)
{
    const size_t row = png_get_rowbytes(png, info), n = (size_t)out->height;
    const int passes = png_get_interlace_type(png, info) == PNG_INTERLACE_NONE ? 1 : 7;
    out->data = row && n <= SIZE_MAX / row ? malloc(row * n) : NULL;
    if (!out->data)
        return false;
    for (int pass = 0; pass < passes; pass++)
        for (size_t y = 0; y < n; y++)
            png_read_row(png, out->data + y * row, NULL);
    png_read_end(png, NULL);
    return true;
}

bool whole_png(const char *path, bool with_data, struct whole *out)
{
    volatile bool good = false; /* survives longjmp() */
    *out = (struct whole){0};
    FILE *f = fopen(path, "rb");
    if (!f) {
        snprintf(out->error, sizeof out->error, "%s", strerror(errno));
        return false;
    }
    png_structp png = png_create_read_struct(PNG_LIBPNG_VER_STRING, out, on_error, on_warning);
    png_infop info = png ? png_create_info_struct(png) : NULL;
    snprintf(out->error, sizeof out->error, "out of memory");
    if (info && setjmp(png_jmpbuf(png)) == 0) {
        png_init_io(png, f);
        read_head(png, info, out);
        good = !with_data || read_data(png, info, out);
    }
    png_destroy_read_struct(&png, &info, NULL);
    fclose(f);
    if (!good) {
        free(out->data);
        out->data = NULL;
    }
    return good;
}
