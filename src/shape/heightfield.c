#include "shape/heightfield.h"

#include <float.h>
#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "image/bilinear.h"
#include "image/image.h"
#include "image/sliding_max.h"

enum { MAX_RIM_STEPS = 200 };

struct heightfield {
    size_t width, height;
    double min[3], max[3]; /* m; max[2]: its highest point */
    double dx, dy;         /* m, size of a pixel */
    double reach;
    double steepness; /* sqrt(1 + the largest slope squared) */
    /* All [height][width], bottom row first: */
    float *z;                 /* m */
    float *low, *high;        /* m, the lowest and highest z within `reach` of any point of this pixel */
    unsigned char *has;       /* does the pixel have a value? NULL: all have */
    unsigned char *rim_steps; /* king's moves to the nearest pixel that differs in `has`, or MAX_RIM_STEPS */
};

static size_t pixels(double metres, double pixel, size_t limit)
{
    double n = ceil(metres / pixel) + 1; /* + 1: bilinear interpolation uses the next pixel */
    return n < (double)limit ? (size_t)n : limit;
}

/* The extremes of the ground around each pixel bound the distance well even beside a cliff. */
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
    TRY(sliding_max(f->width, f->height, rx, ry, f->high));
    TRY(sliding_max(f->width, f->height, rx, ry, f->low));
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

/* Copies the image with its bottom row first, and checks the heights. */
static status copy_pixels(struct heightfield *f, const char *path, const struct image *image)
{
    f->max[2] = f->min[2];
    for (size_t y = 0; y < f->height; y++)
        for (size_t x = 0; x < f->width; x++) {
            const size_t from = (f->height - 1 - y) * f->width + x, to = y * f->width + x;
            const double z = (double)image->value[from];
            if (!(fabs(z) <= 1e7))
                return fail(
                    E_INPUT,
                    "%s: pixel (%zu, %zu) from the top left has a height of %g m, beyond 1e7 m: check scale_m, nodata_value and max_m",
                    path, x, f->height - 1 - y, z);
            f->z[to] = (float)z;
            if (f->has)
                f->has[to] = image->has[from];
            if (!f->has || f->has[to])
                f->max[2] = fmax(f->max[2], z);
        }
    return OK;
}

/* Chebyshev distances (king's moves) by two raster sweeps. */
static void find_rim_steps(struct heightfield *f)
{
    const long w = (long)f->width, h = (long)f->height;
    memset(f->rim_steps, MAX_RIM_STEPS, f->width * f->height);
    for (long k = 0; k < 2 * w * h; k++) {
        const bool back = k >= w * h;
        const long i = back ? 2 * w * h - 1 - k : k, x = i % w, y = i / w, d = back ? 1 : -1;
        const long neighbour[4][2] = {{d, 0}, {-1, d}, {0, d}, {1, d}};
        for (int n = 0; n < 4; n++) {
            const long u = x + neighbour[n][0], v = y + neighbour[n][1], j = v * w + u;
            if (u < 0 || v < 0 || u >= w || v >= h)
                continue;
            if (f->has[j] != f->has[i])
                f->rim_steps[i] = f->rim_steps[j] = 1;
            else if (f->rim_steps[j] < f->rim_steps[i])
                f->rim_steps[i] = (unsigned char)(f->rim_steps[j] + 1);
        }
    }
}

/* Heights are stored values times scale_m, metres by the file's own metadata, or min_m.z to max_m.z for black to white. */
static struct image_request request_of(const struct job_heightfield *job)
{
    struct image_request request = IMAGE_REQUEST(job);
    request.height = true;
    if (job->scale_m != 0 || job_heights_are_metres(job)) {
        request.values = job->scale_m != 0 ? IMAGE_STORED : IMAGE_METRES;
        request.scale = job->scale_m != 0 ? job->scale_m : 1;
        request.offset = job->offset_m;
    } else {
        request.scale = job->max_m[2] - job->min_m[2];
        request.offset = job->min_m[2];
    }
    return request;
}

static status extent_from_map(struct heightfield *f, const struct job_heightfield *job,
                              const struct image *image)
{
    char what[400];
    if (image->map == IMAGE_NO_MAP)
        return fail(E_USAGE,
                    "%s: max_m is omitted, but the file does not say how large its pixels are: set max_m",
                    job->file);
    if (image->map == IMAGE_MAP_TURNED)
        return fail(
            E_USAGE,
            "%s: it is rotated against its map's axes: set max_m, or straighten it: gdalwarp %s straight.tif",
            job->file, job->file);
    if (image->map == IMAGE_MAP_DEGREES)
        return fail(
            E_USAGE,
            "%s: its pixels are in degrees of longitude and latitude, which have no size in metres: set max_m, or project it: gdalwarp -t_srs EPSG:326NN -r bilinear %s metres.tif, where NN is the UTM zone (327NN in the south)",
            job->file, job->file);
    for (int a = 0; a < 2; a++) {
        const size_t n = a ? f->height : f->width;
        if (job->origin_m[0] != 0 || job->origin_m[1] != 0)
            f->min[a] += image->corner[a] - job->origin_m[a];
        f->max[a] = f->min[a] + image->pixel[a] * (double)n;
    }
    snprintf(
        what, sizeof what,
        "%zu x %zu pixels of %.6g x %.6g m by its metadata%s: x %.10g to %.10g, y %.10g to %.10g m; its bottom left corner is at (%.10g, %.10g) on its map",
        f->width, f->height, image->pixel[0], image->pixel[1],
        image->map_named ? "" : ", which does not name its unit (metres are assumed)", f->min[0], f->max[0],
        f->min[1], f->max[1], image->corner[0], image->corner[1]);
    image_log(false, job->file, what);
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
    status st = job_sizes_heightfield(job) ? OK : extent_from_map(f, job, image);
    f->dx = (f->max[0] - f->min[0]) / (double)f->width;
    f->dy = (f->max[1] - f->min[1]) / (double)f->height;
    return st;
}

status heightfield_create(const struct job_heightfield *job, double reach, struct heightfield **out)
{
    status st = OK;
    struct heightfield *f = NULL;
    struct image image = {0};
    const struct image_request request = request_of(job);
    TRY(memory_alloc(1, sizeof *f, "a heightfield", &f));
    f->reach = reach;
    TRY(image_read(&request, &image));
    TRY(place_corners(f, job, &image));
    const size_t n = f->width * f->height;
    TRY(memory_alloc(n, sizeof *f->z, "a heightfield", &f->z));
    if (image.has) {
        TRY(memory_alloc(n, 1, "a heightfield", &f->has));
        TRY(memory_alloc(n, 1, "a heightfield", &f->rim_steps));
    }
    TRY(copy_pixels(f, job->file, &image));
    image_free(&image);
    if (f->rim_steps)
        find_rim_steps(f);
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
    free((*field)->rim_steps);
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

/* The integral of the bilinear surface, constant beyond the outermost pixel centres, is the sum over pixels. */
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

/* The distance to the rim between pixels with and without a value, negative where pixel (i, j) has one: exact next to the rim, else a
 * lower bound in whole pixels. */
static double rim_distance(const struct heightfield *f, double px, double py, size_t i, size_t j)
{
    const size_t pixel = j * f->width + i;
    const double least = fmin(f->dx, f->dy);
    double d = least * fmax(1, f->rim_steps[pixel] - 1);
    for (int k = 0; f->rim_steps[pixel] == 1 && k < 9; k++) {
        const size_t u = i + (size_t)(k % 3) - 1,
                     v = j + (size_t)(k / 3) - 1; /* -1 wraps to more than any size */
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
    /* Two lower bounds: within `reach` the ground is between low and high, and nowhere is it steeper than its steepest slope. */
    double rise = x[2] - image_bilinear(f->z, f->width, f->height, px, py), d = rise / f->steepness;
    if (rise > 0)
        d = fmax(d, fmin(f->reach, x[2] - f->high[pixel]));
    else
        d = fmin(d, fmax(-f->reach, x[2] - f->low[pixel]));
    if (f->rim_steps)
        d = fmax(d, rim_distance(f, px, py, i, j));
    d = fmax(d, f->min[2] - x[2]);
    d = fmax(d, fmax(f->min[0] - x[0], x[0] - f->max[0]));
    return fmax(d, fmax(f->min[1] - x[1], x[1] - f->max[1]));
}
