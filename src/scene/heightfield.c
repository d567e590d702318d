#include "scene/heightfield.h"

#include <math.h>
#include <stdlib.h>

#include "base/memory.h"
#include "scene/image.h"

struct heightfield {
    size_t width, height;
    double min[3], max[3]; /* max[2]: height of white */
    double dx, dy;         /* m, a pixel */
    double reach, top;
    double steepness;  /* sqrt(1 + the largest slope squared) */
    float *z;          /* m, bottom row first */
    float *low, *high; /* lowest and highest z within `reach` of a point in this pixel */
};

/* out[i] = the largest of in[i - radius .. i + radius], over n items `stride` apart (van Herk's running
 * maximum is not needed: a queue of falling candidates does it in one sweep). `queue` has n items. */
static void spread_max(float *line, size_t n, size_t stride, size_t radius, float *copy, size_t *queue)
{
    size_t head = 0, tail = 0, next = 0;
    for (size_t i = 0; i < n; i++)
        copy[i] = line[i * stride];
    for (size_t i = 0; i < n; i++) {
        for (; next < n && next <= i + radius; next++) {
            while (tail > head && copy[queue[tail - 1]] <= copy[next])
                tail--;
            queue[tail++] = next;
        }
        while (queue[head] + radius < i)
            head++;
        line[i * stride] = copy[queue[head]];
    }
}

static size_t pixels(double metres, double pixel, size_t limit)
{
    double n = ceil(metres / pixel) + 1; /* + 1: bilinear values lean on the next pixel */
    return n < (double)limit ? (size_t)n : limit;
}

/* The extremes of the ground around each pixel, which bound the distance well even beside a cliff. */
static status find_extremes(struct heightfield *f)
{
    status st = OK;
    size_t n = f->width * f->height, longest = f->width > f->height ? f->width : f->height;
    size_t rx = pixels(f->reach, f->dx, f->width), ry = pixels(f->reach, f->dy, f->height);
    float *copy = NULL;
    size_t *queue = NULL;
    TRY(memory_alloc(n, sizeof *f->low, "a heightfield", &f->low));
    TRY(memory_alloc(n, sizeof *f->high, "a heightfield", &f->high));
    TRY(memory_alloc(longest, sizeof *copy, "a heightfield", &copy));
    TRY(memory_alloc(longest, sizeof *queue, "a heightfield", &queue));
    for (size_t i = 0; i < n; i++) {
        f->high[i] = f->z[i];
        f->low[i] = -f->z[i];
    }
    for (int side = 0; side < 2; side++) {
        float *field = side ? f->high : f->low;
        for (size_t y = 0; y < f->height; y++)
            spread_max(field + y * f->width, f->width, 1, rx, copy, queue);
        for (size_t x = 0; x < f->width; x++)
            spread_max(field + x, f->height, f->width, ry, copy, queue);
    }
    for (size_t i = 0; i < n; i++)
        f->low[i] = -f->low[i];
done:
    free(copy);
    free(queue);
    return st;
}

static double largest_slope(const struct heightfield *f, size_t step_x, size_t step_y, double metres)
{
    float largest = 0;
    for (size_t y = 0; y + step_y < f->height; y++)
        for (size_t x = 0; x + step_x < f->width; x++)
            largest =
                fmaxf(largest, fabsf(f->z[(y + step_y) * f->width + x + step_x] - f->z[y * f->width + x]));
    return largest / metres;
}

/* Metres from the image's values, and the image's top row last. */
static status place_pixels(struct heightfield *f, const char *path, const float *value)
{
    f->top = f->min[2];
    for (size_t y = 0; y < f->height; y++)
        for (size_t x = 0; x < f->width; x++) {
            double v = value[(f->height - 1 - y) * f->width + x];
            double z = f->min[2] + v * (f->max[2] - f->min[2]);
            if (!(fabs(z) <= 1e7))
                return fail(E_INPUT, "%s: pixel (%zu, %zu) from the top left holds %g, a height of %g m",
                            path, x, f->height - 1 - y, v, z);
            f->z[y * f->width + x] = (float)z;
            f->top = fmax(f->top, z);
        }
    return OK;
}

status heightfield_create(const struct job_heightfield *job, double reach, struct heightfield **out)
{
    status st = OK;
    struct heightfield *f = NULL;
    float *value = NULL;
    TRY(memory_alloc(1, sizeof *f, "a heightfield", &f));
    TRY(image_read(job->file, &f->width, &f->height, &value));
    for (int a = 0; a < 3; a++) {
        f->min[a] = job->min_m[a];
        f->max[a] = job->max_m[a];
    }
    f->reach = reach;
    f->dx = (f->max[0] - f->min[0]) / (double)f->width;
    f->dy = (f->max[1] - f->min[1]) / (double)f->height;
    TRY(memory_alloc(f->width * f->height, sizeof *f->z, "a heightfield", &f->z));
    TRY(place_pixels(f, job->file, value));
    double slope_x = largest_slope(f, 1, 0, f->dx), slope_y = largest_slope(f, 0, 1, f->dy);
    f->steepness = sqrt(1 + slope_x * slope_x + slope_y * slope_y);
    TRY(find_extremes(f));
    *out = f;
    f = NULL;
done:
    free(value);
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
    free(*field);
    *field = NULL;
}

double heightfield_top(const struct heightfield *field)
{
    return field->top;
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
    d = fmax(d, f->min[2] - x[2]);
    d = fmax(d, fmax(f->min[0] - x[0], x[0] - f->max[0]));
    return fmax(d, fmax(f->min[1] - x[1], x[1] - f->max[1]));
}
