#include "shape/heightfield.h"

#include <float.h>
#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "image/image.h"
#include "image/spread.h"

enum { AWAY = 200 };

struct heightfield {
    size_t width, height;
    double min[3], max[3]; /* m; max[2]: of its highest point */
    double dx, dy;         /* m, a pixel */
    double reach;
    double steepness;  /* sqrt(1 + the largest slope squared) */
    float *z;          /* m, bottom row first */
    float *low, *high; /* lowest and highest z within `reach` of a point in this pixel */
    unsigned char *
        away; /* bottom row first: steps to the nearest pixel of which one has a value and the other has none, in both
                            directions at most AWAY; NULL: all have */
    unsigned char *has;
};

static size_t pixels(double metres, double pixel, size_t limit)
{
    double n = ceil(metres / pixel) + 1; /* + 1: bilinear values lean on the next pixel */
    return n < (double)limit ? (size_t)n : limit;
}

/* The extremes of the ground around each pixel, which bound the distance well even beside a cliff. */
static status find_extremes(struct heightfield *f)
{
    status st = OK;
    const size_t n = f->width * f->height;
    const size_t rx = pixels(f->reach, f->dx, f->width), ry = pixels(f->reach, f->dy, f->height);
    TRY(memory_alloc(n, sizeof *f->low, "a heightfield", &f->low));
    TRY(memory_alloc(n, sizeof *f->high, "a heightfield", &f->high));
    for (size_t i = 0; i < n; i++) {
        f->high[i] = f->z[i];
        f->low[i] = -f->z[i];
    }
    TRY(spread_largest(f->width, f->height, rx, ry, f->high));
    TRY(spread_largest(f->width, f->height, rx, ry, f->low));
    for (size_t i = 0; i < n; i++)
        f->low[i] = -f->low[i];
done:
    return st;
}

static double largest_slope(const struct heightfield *f, size_t step_x, size_t step_y, double metres)
{
    float largest = 0;
    for (size_t y = 0; y + step_y < f->height; y++)
        for (size_t x = 0; x + step_x < f->width; x++)
            largest =
                fmaxf(fabsf(f->z[(y + step_y) * f->width + x + step_x] - f->z[y * f->width + x]), largest);
    return (double)largest / metres;
}

/* The image's bottom row first. */
static status place_pixels(struct heightfield *f, const char *path, const struct image *image)
{
    f->max[2] = f->min[2];
    for (size_t y = 0; y < f->height; y++)
        for (size_t x = 0; x < f->width; x++) {
            const size_t from = (f->height - 1 - y) * f->width + x, to = y * f->width + x;
            const double z = (double)image->value[from];
            if (!(fabs(z) <= 1e7))
                return fail(E_INPUT,
                            "%s: pixel (%zu, %zu) from the top left is a height of %g m (at most 1e7)", path,
                            x, f->height - 1 - y, z);
            f->z[to] = (float)z;
            if (f->has)
                f->has[to] = image->has[from];
            if (!f->has || f->has[to])
                f->max[2] = fmax(f->max[2], z);
        }
    return OK;
}

/* Steps of a king to where pixels stop having a value, or begin to, in two sweeps. */
static void find_away(struct heightfield *f)
{
    const long w = (long)f->width, h = (long)f->height;
    memset(f->away, AWAY, f->width * f->height);
    for (long k = 0; k < 2 * w * h; k++) {
        const bool back = k >= w * h;
        const long i = back ? 2 * w * h - 1 - k : k, x = i % w, y = i / w, d = back ? 1 : -1;
        const long near[4][2] = {{d, 0}, {-1, d}, {0, d}, {1, d}};
        for (int n = 0; n < 4; n++) {
            const long u = x + near[n][0], v = y + near[n][1], j = v * w + u;
            if (u < 0 || v < 0 || u >= w || v >= h)
                continue;
            if (f->has[j] != f->has[i])
                f->away[i] = f->away[j] = 1;
            else if (f->away[j] < f->away[i])
                f->away[i] = (unsigned char)(f->away[j] + 1);
        }
    }
}

/* Where the file's own pixels are to say how large the picture is, they do; and the heights' meaning, where that is left to it. */
static struct image_wish wish_of(const struct job_heightfield *job)
{
    struct image_wish wish = IMAGE_WISH(job);
    wish.height = true;
    if (job->scale_m != 0 || job_heights_are_metres(job)) {
        wish.values = job->scale_m != 0 ? IMAGE_STORED : IMAGE_METRES;
        wish.scale = job->scale_m != 0 ? job->scale_m : 1;
        wish.offset = job->offset_m;
    } else {
        wish.scale = job->max_m[2] - job->min_m[2];
        wish.offset = job->min_m[2];
    }
    return wish;
}

static status take_extent(struct heightfield *f, const struct job_heightfield *job, const struct image *image)
{
    char what[400];
    if (image->map == IMAGE_NO_MAP)
        return fail(E_USAGE,
                    "%s: max_m is left out, and the file does not say how large its pixels are: give max_m",
                    job->file);
    if (image->map == IMAGE_MAP_TURNED)
        return fail(E_USAGE, "%s: it lies askew on its map: give max_m, or turn it: gdalwarp %s straight.tif",
                    job->file, job->file);
    if (image->map == IMAGE_MAP_DEGREES)
        return fail(
            E_USAGE,
            "%s: its pixels are degrees of longitude and latitude, which have no size in metres: give max_m, or project it: gdalwarp -t_srs EPSG:326NN -r bilinear %s metres.tif, NN the UTM zone (327NN in the south)",
            job->file, job->file);
    for (int a = 0; a < 2; a++) {
        const size_t n = a ? f->height : f->width;
        if (job->origin_m[0] != 0 || job->origin_m[1] != 0)
            f->min[a] += image->corner[a] - job->origin_m[a];
        f->max[a] = f->min[a] + image->pixel[a] * (double)n;
    }
    snprintf(
        what, sizeof what,
        "%zu x %zu pixels of %.6g x %.6g m by its own word%s: x %.10g to %.10g, y %.10g to %.10g m; its left bottom corner is at (%.10g, %.10g) on its map",
        f->width, f->height, image->pixel[0], image->pixel[1],
        image->map_named ? "" : ", which does not say that it means metres", f->min[0], f->max[0], f->min[1],
        f->max[1], image->corner[0], image->corner[1]);
    image_say(false, job->file, what);
    return OK;
}

static status place_corners(struct heightfield *f, const struct job_heightfield *job,
                            const struct image *image)
{
    f->width = image->width;
    f->height = image->height;
    for (int a = 0; a < 3; a++) {
        f->min[a] = job->min_m[a];
        f->max[a] = job->max_m[a];
    }
    status st = job_sizes_heightfield(job) ? OK : take_extent(f, job, image);
    f->dx = (f->max[0] - f->min[0]) / (double)f->width;
    f->dy = (f->max[1] - f->min[1]) / (double)f->height;
    return st;
}

status heightfield_create(const struct job_heightfield *job, double reach, struct heightfield **out)
{
    status st = OK;
    struct heightfield *f = NULL;
    struct image image = {0};
    const struct image_wish wish = wish_of(job);
    TRY(memory_alloc(1, sizeof *f, "a heightfield", &f));
    f->reach = reach;
    TRY(image_read(&wish, &image));
    TRY(place_corners(f, job, &image));
    const size_t n = f->width * f->height;
    TRY(memory_alloc(n, sizeof *f->z, "a heightfield", &f->z));
    if (image.has) {
        TRY(memory_alloc(n, 1, "a heightfield", &f->has));
        TRY(memory_alloc(n, 1, "a heightfield", &f->away));
    }
    TRY(place_pixels(f, job->file, &image));
    image_free(&image);
    if (f->away)
        find_away(f);
    double slope_x = largest_slope(f, 1, 0, f->dx), slope_y = largest_slope(f, 0, 1, f->dy);
    f->steepness = sqrt(1 + slope_x * slope_x + slope_y * slope_y);
    TRY(find_extremes(f));
    *out = f;
    f = NULL;
done:
    image_free(&image);
    heightfield_destroy(&f);
    return st;
}

void heightfield_destroy(struct heightfield **field)
{
    if (!*field)
        return;
    free((*field)->z);
    free((*field)->low);
    free((*field)->high);
    free((*field)->has);
    free((*field)->away);
    free(*field);
    *field = NULL;
}

void heightfield_bounds(const struct heightfield *field, double min[3], double max[3])
{
    for (int a = 0; a < 3; a++) {
        min[a] = field->min[a];
        max[a] = field->max[a];
    }
}

/* The integral of bilinear values whose outermost go on is the pixels' sum. */
double heightfield_volume(const struct heightfield *f)
{
    double sum = 0;
    for (size_t i = 0; i < f->width * f->height; i++)
        if (!f->has || f->has[i])
            sum += fmax((double)f->z[i] - f->min[2], 0);
    return sum * f->dx * f->dy;
}

static double clamp(double x, double lo, double hi)
{
    return fmin(fmax(x, lo), hi);
}

static double height_at(const struct heightfield *f, double px, double py)
{
    double x = clamp(px - 0.5, 0, (double)(f->width - 1)), y = clamp(py - 0.5, 0, (double)(f->height - 1));
    size_t i = (size_t)x, j = (size_t)y;
    size_t right = i + 1 < f->width ? 1 : 0, up = j + 1 < f->height ? f->width : 0;
    const float *z = f->z + j * f->width + i;
    double u = x - (double)i, v = y - (double)j;
    double bottom = z[0] + u * (z[right] - z[0]);
    double top = z[up] + u * (z[up + right] - z[up]);
    return bottom + v * (top - bottom);
}

/* To where pixels stop having a value, negative in one that has. In pixel (i, j), beside one that differs, to the nearest such;
 * else, and at most, by whole pixels. */
static double rim_distance(const struct heightfield *f, double px, double py, size_t i, size_t j)
{
    const size_t pixel = j * f->width + i;
    const double least = fmin(f->dx, f->dy);
    double d = least * fmax(1, f->away[pixel] - 1);
    for (int k = 0; f->away[pixel] == 1 && k < 9; k++) {
        const size_t u = i + (size_t)(k % 3) - 1,
                     v = j + (size_t)(k / 3) - 1; /* below 0: more than any width */
        if (u >= f->width || v >= f->height || f->has[v * f->width + u] == f->has[pixel])
            continue;
        const double away_x = fmax(fmax((double)u - px, px - (double)u - 1), 0) * f->dx;
        const double away_y = fmax(fmax((double)v - py, py - (double)v - 1), 0) * f->dy;
        d = fmin(d, hypot(away_x, away_y));
    }
    return f->has[pixel] ? -d : fmax(d, DBL_MIN);
}

double heightfield_distance(const struct heightfield *f, const double x[3])
{
    double px = clamp((x[0] - f->min[0]) / f->dx, 0, (double)f->width);
    double py = clamp((x[1] - f->min[1]) / f->dy, 0, (double)f->height);
    size_t i = px < (double)f->width ? (size_t)px : f->width - 1;
    size_t j = py < (double)f->height ? (size_t)py : f->height - 1;
    size_t pixel = j * f->width + i;
    /* Nearer than `reach`, the ground lies between low and high; in any case it is no steeper than its
     * steepest. */
    double rise = x[2] - height_at(f, px, py), d = rise / f->steepness;
    if (rise > 0)
        d = fmax(d, fmin(f->reach, x[2] - f->high[pixel]));
    else
        d = fmin(d, fmax(-f->reach, x[2] - f->low[pixel]));
    if (f->away)
        d = fmax(d, rim_distance(f, px, py, i, j));
    d = fmax(d, f->min[2] - x[2]);
    d = fmax(d, fmax(f->min[0] - x[0], x[0] - f->max[0]));
    return fmax(d, fmax(f->min[1] - x[1], x[1] - f->max[1]));
}
