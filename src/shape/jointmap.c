#include "shape/jointmap.h"

#include <math.h>
#include <stdlib.h>

#include "base/memory.h"
#include "image/bilinear.h"
#include "image/image.h"

/* Uncertainty of the outline's distance, pixels: it is somewhere between the centres of two pixels that differ (up to sqrt(2) from
 * either), and a point is up to sqrt(1/2) from its pixel's centre. */
static const double UNCERTAINTY = 2.2;

struct jointmap {
    size_t width, height;
    double min[3], max[3];
    double dx, dy;    /* m, size of a pixel */
    double steepness; /* sqrt(1 + the largest slope of the tops squared) */
    float *rock;      /* [height][width], bottom row first: 1 or 0 */
    float *top;       /* m, the column's top; black pixels have that of the nearest column */
    float *steps;     /* to the nearest pixel that differs in `rock`, diagonal steps included */
};

/* One raster sweep, which propagates distances and tops from the four neighbours already visited. */
static void sweep(struct jointmap *m, const float *rock, bool back)
{
    for (size_t s = 0; s < m->width * m->height; s++) {
        size_t i = back ? m->width * m->height - 1 - s : s;
        long x = (long)(i % m->width), y = (long)(i / m->width), d = back ? 1 : -1;
        const long neighbour[4][2] = {{d, 0}, {-1, d}, {0, d}, {1, d}};
        for (int k = 0; k < 4; k++) {
            long u = x + neighbour[k][0], w = y + neighbour[k][1];
            if (u < 0 || w < 0 || u >= (long)m->width || w >= (long)m->height)
                continue;
            size_t j = (size_t)w * m->width + (size_t)u;
            float through = rock[j] != rock[i] ? 1 : m->steps[j] + 1;
            if (through < m->steps[i]) {
                m->steps[i] = through;
                if (rock[i] == 0)
                    m->top[i] = m->top[j];
            }
        }
    }
}

static status read_pixels(struct jointmap *m, const struct job_jointmap *job, const float *value)
{
    size_t n_rock = 0;
    double slope = 0;
    for (size_t y = 0; y < m->height; y++)
        for (size_t x = 0; x < m->width; x++) {
            double v = value[(m->height - 1 - y) * m->width + x];
            size_t i = y * m->width + x;
            if (!(fabs(v) <= 1e6))
                return fail(
                    E_INPUT,
                    "%s: pixel (%zu, %zu) from the top left is %g, beyond 1e6: check channel and nodata_value",
                    job->file, x, m->height - 1 - y, v);
            m->rock[i] = v > job->black;
            m->top[i] = (float)(job->reach ? m->min[2] + fmin(v, 1) * (m->max[2] - m->min[2]) : m->max[2]);
            m->steps[i] = 1e9f;
            n_rock += v > job->black;
        }
    if (n_rock == 0)
        return fail(
            E_USAGE,
            "%s: no pixel is brighter than jointmap.black, %g, so that there is no rock: lower jointmap.black",
            job->file, job->black);
    for (int round = 0; round < 2; round++) {
        sweep(m, m->rock, false);
        sweep(m, m->rock, true);
    }
    for (size_t i = 0; i + m->width < m->width * m->height; i++)
        slope = fmax(slope, fabs((double)(m->top[i + m->width] - m->top[i])) / m->dy);
    for (size_t i = 0; i + 1 < m->width * m->height; i++)
        if ((i + 1) % m->width)
            slope = fmax(slope, fabs((double)(m->top[i + 1] - m->top[i])) / m->dx);
    m->steepness = sqrt(1 + 2 * slope * slope);
    return OK;
}

status jointmap_create(const struct job_jointmap *job, struct jointmap **out)
{
    status st = OK;
    struct jointmap *m = NULL;
    struct image image = {0};
    const struct image_request request = IMAGE_REQUEST(job);
    TRY(memory_alloc(1, sizeof *m, "a joint map", &m));
    TRY(image_read(&request, &image));
    m->width = image.width;
    m->height = image.height;
    for (int a = 0; a < 3; a++) {
        m->min[a] = job->min_m[a];
        m->max[a] = job->max_m[a];
    }
    m->dx = (m->max[0] - m->min[0]) / (double)m->width;
    m->dy = (m->max[1] - m->min[1]) / (double)m->height;
    TRY(memory_alloc(m->width * m->height, sizeof *m->rock, "a joint map", &m->rock));
    TRY(memory_alloc(m->width * m->height, sizeof *m->top, "a joint map", &m->top));
    TRY(memory_alloc(m->width * m->height, sizeof *m->steps, "a joint map", &m->steps));
    TRY(read_pixels(m, job, image.value));
    *out = m;
    m = NULL;
done:
    image_free(&image);
    jointmap_destroy(&m);
    return st;
}

void jointmap_destroy(struct jointmap **map)
{
    if (!*map)
        return;
    free((*map)->rock);
    free((*map)->top);
    free((*map)->steps);
    free(*map);
    *map = NULL;
}

static double clamp(double x, double low, double high)
{
    return fmin(fmax(x, low), high);
}

static double at(const struct jointmap *m, const float *field, double px, double py)
{
    return image_bilinear(field, m->width, m->height, px, py);
}

double jointmap_distance(const struct jointmap *m, const double x[3])
{
    double px = clamp((x[0] - m->min[0]) / m->dx, 0, (double)m->width);
    double py = clamp((x[1] - m->min[1]) / m->dy, 0, (double)m->height);
    size_t i = px < (double)m->width ? (size_t)px : m->width - 1;
    size_t j = py < (double)m->height ? (size_t)py : m->height - 1;
    double least = fmax((double)m->steps[j * m->width + i] - UNCERTAINTY, 0) * fmin(m->dx, m->dy);
    double d = at(m, m->rock, px, py) >= 0.5 ? -fmax(least, 1e-9) : fmax(least, 1e-9);
    d = fmax(d, (x[2] - at(m, m->top, px, py)) / m->steepness);
    d = fmax(d, m->min[2] - x[2]);
    d = fmax(d, fmax(m->min[0] - x[0], x[0] - m->max[0]));
    return fmax(d, fmax(m->min[1] - x[1], x[1] - m->max[1]));
}
