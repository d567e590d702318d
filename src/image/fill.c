/* A pyramid, filled from coarse to fine. A pixel of a coarser level is the average of the known ones of four finer pixels. The filled
 * coarse level gives the gaps of the finer one their first values, which Gauss-Seidel sweeps relax towards the mean of their neighbours
 * (Laplace's equation, a soap film over the gap). */
#include "image/fill.h"

#include <math.h>
#include <stdlib.h>

#include "base/memory.h"

enum { SWEEPS = 12 };

struct level {
    size_t width, height;
    float *value;
};

static status list_gaps(const struct level *l, size_t **out, size_t *n)
{
    status st = OK;
    size_t capacity = 0;
    *n = 0;
    *out = NULL;
    for (size_t i = 0; i < l->width * l->height; i++)
        if (isnan(l->value[i])) {
            if (*n == capacity)
                TRY(memory_grow(out, &capacity, *n + 1, sizeof **out, "gaps of an image"));
            (*out)[(*n)++] = i;
        }
done:
    return st;
}

static void average(const struct level *fine, struct level *coarse)
{
    for (size_t y = 0; y < coarse->height; y++)
        for (size_t x = 0; x < coarse->width; x++) {
            double sum = 0, n = 0;
            for (size_t k = 0; k < 4; k++) {
                const size_t u = 2 * x + k % 2, v = 2 * y + k / 2;
                if (u >= fine->width || v >= fine->height || isnan(fine->value[v * fine->width + u]))
                    continue;
                sum += (double)fine->value[v * fine->width + u];
                n++;
            }
            coarse->value[y * coarse->width + x] = n > 0 ? (float)(sum / n) : NAN;
        }
}

/* The coarse level at pixel (x, y) of the finer one, bilinear between pixel centres. */
static float upsample(const struct level *coarse, size_t x, size_t y)
{
    const double px = fmin(fmax(((double)x + 0.5) / 2 - 0.5, 0), (double)(coarse->width - 1));
    const double py = fmin(fmax(((double)y + 0.5) / 2 - 0.5, 0), (double)(coarse->height - 1));
    const size_t i = (size_t)px, j = (size_t)py;
    const size_t right = i + 1 < coarse->width ? 1 : 0, down = j + 1 < coarse->height ? coarse->width : 0;
    const float *f = coarse->value + j * coarse->width + i;
    const double u = px - (double)i, v = py - (double)j;
    const double top = (double)f[0] + u * ((double)f[right] - (double)f[0]);
    const double bottom = (double)f[down] + u * ((double)f[down + right] - (double)f[down]);
    return (float)(top + v * (bottom - top));
}

static void relax(struct level *l, const size_t *gap, size_t n)
{
    for (size_t i = 0; i < n; i++) {
        const size_t x = gap[i] % l->width, y = gap[i] / l->width;
        double sum = 0, count = 0;
        const float *at = l->value + gap[i];
        if (x > 0)
            sum += (double)at[-1], count++;
        if (x + 1 < l->width)
            sum += (double)at[1], count++;
        if (y > 0)
            sum += (double)*(at - l->width), count++;
        if (y + 1 < l->height)
            sum += (double)at[l->width], count++;
        if (count > 0)
            l->value[gap[i]] = (float)(sum / count);
    }
}

static status fill(struct level *l)
{
    status st = OK;
    size_t *gap = NULL, n;
    struct level coarse = {(l->width + 1) / 2, (l->height + 1) / 2, NULL};
    TRY(list_gaps(l, &gap, &n));
    if (n == 0 || n == l->width * l->height)
        goto done;
    TRY(memory_alloc(coarse.width * coarse.height, sizeof *coarse.value, "gaps of an image", &coarse.value));
    average(l, &coarse);
    TRY(fill(&coarse));
    for (size_t i = 0; i < n; i++)
        l->value[gap[i]] = upsample(&coarse, gap[i] % l->width, gap[i] / l->width);
    for (int sweep = 0; sweep < SWEEPS; sweep++)
        relax(l, gap, n);
done:
    free(gap);
    free(coarse.value);
    return st;
}

status image_fill(size_t width, size_t height, float *value)
{
    return fill(&(struct level){width, height, value});
}
