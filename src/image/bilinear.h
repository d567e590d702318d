/* Bilinear interpolation between pixel centres. */
#ifndef HOODOO_IMAGE_BILINEAR_H
#define HOODOO_IMAGE_BILINEAR_H

#include <math.h>
#include <stddef.h>

/* The value of an image value[height][width] at (px, py), in pixels from the corner of value[0]. Constant beyond the outermost pixel
 * centres. */
static inline double image_bilinear(const float *value, size_t width, size_t height, double px, double py)
{
    const double x = fmin(fmax(px - 0.5, 0), (double)(width - 1));
    const double y = fmin(fmax(py - 0.5, 0), (double)(height - 1));
    const size_t i = (size_t)x, j = (size_t)y;
    const size_t next = i + 1 < width ? 1 : 0, row = j + 1 < height ? width : 0;
    const float *f = value + j * width + i;
    const double u = x - (double)i, v = y - (double)j;
    const double a = (double)f[0] + u * (double)(f[next] - f[0]);
    const double b = (double)f[row] + u * (double)(f[row + next] - f[row]);
    return a + v * (b - a);
}

#endif
