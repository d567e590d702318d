#include "scene/projection.h"

#include <math.h>
#include <stdlib.h>

#include "base/memory.h"
#include "base/vector.h"
#include "image/bilinear.h"
#include "image/image.h"

/* The depth of the first rock behind the image is stored in cells of a spacing, at most this many a side. */
#define MAX_CELLS 8192.0

struct projection {
    struct image image;                         /* its values, top row first */
    double corner[3], right[3], up[3], away[3]; /* m; unit vectors */
    double size[2];                             /* m */
    double depth;                               /* m; 0: unlimited */
    double h, cell;                             /* m */
    size_t cells[2];
    float *first; /* [cells[1]][cells[0]]: distance from the image to the first rock, m */
};

/* x relative to the image's corner, along its right, up and away vectors, m. */
static void to_image_space(const struct projection *p, const double x[3], double out[3])
{
    const double d[3] = {x[0] - p->corner[0], x[1] - p->corner[1], x[2] - p->corner[2]};
    out[0] = dot3(d, p->right);
    out[1] = dot3(d, p->up);
    out[2] = dot3(d, p->away);
}

status projection_create(const struct job_image *job, double h, struct projection **out)
{
    status st = OK;
    struct projection *p = NULL;
    const struct image_request request = IMAGE_REQUEST(job);
    TRY(memory_alloc(1, sizeof *p, "an image", &p));
    TRY(image_read(&request, &p->image));
    p->size[0] = sqrt(dot3(job->right_m, job->right_m));
    p->size[1] = sqrt(dot3(job->up_m, job->up_m));
    for (int a = 0; a < 3; a++) {
        p->corner[a] = job->corner_m[a];
        p->right[a] = job->right_m[a] / p->size[0];
        p->up[a] = job->up_m[a] / p->size[1];
    }
    for (int a = 0; a < 3; a++) {
        int b = (a + 1) % 3, c = (a + 2) % 3;
        p->away[a] = p->up[b] * p->right[c] - p->up[c] * p->right[b];
    }
    p->h = h;
    p->depth = job->depth_m;
    if (p->depth > 0) {
        p->cell = fmax(h, fmax(p->size[0], p->size[1]) / MAX_CELLS);
        for (int a = 0; a < 2; a++)
            p->cells[a] = (size_t)fmax(1, ceil(p->size[a] / p->cell));
        TRY(memory_alloc(p->cells[0] * p->cells[1], sizeof *p->first, "an image's depths", &p->first));
        for (size_t i = 0; i < p->cells[0] * p->cells[1]; i++)
            p->first[i] = INFINITY;
    }
    *out = p;
    p = NULL;
done:
    projection_destroy(&p);
    return st;
}

void projection_destroy(struct projection **projection)
{
    if (!*projection)
        return;
    image_free(&(*projection)->image);
    free((*projection)->first);
    free(*projection);
    *projection = NULL;
}

bool projection_needs_occluders(const struct projection *p)
{
    return p->first != NULL;
}

/* A particle occludes cells within a spacing, so that jitter leaves no gaps between neighbours. */
void projection_add_occluder(struct projection *p, const double x[3])
{
    double at[3];
    to_image_space(p, x, at);
    if (!p->first || at[2] < 0)
        return;
    for (double dv = -1; dv <= 1; dv++)
        for (double du = -1; du <= 1; du++) {
            double u = floor(at[0] / p->cell) + du, v = floor(at[1] / p->cell) + dv;
            double off_u = (u + 0.5) * p->cell - at[0], off_v = (v + 0.5) * p->cell - at[1];
            bool own = du == 0 && dv == 0;
            if (u < 0 || v < 0 || u >= (double)p->cells[0] || v >= (double)p->cells[1] ||
                (!own && off_u * off_u + off_v * off_v > p->h * p->h))
                continue;
            float *first = &p->first[(size_t)v * p->cells[0] + (size_t)u];
            *first = fminf(*first, (float)at[2]);
        }
}

static double sample(const struct projection *p, double u, double v)
{
    const struct image *m = &p->image;
    const double value =
        image_bilinear(m->value, m->width, m->height, u * (double)m->width, (1 - v) * (double)m->height);
    return fmin(fmax(value, 0), 1);
}

double projection_at(const struct projection *p, const double x[3])
{
    double at[3];
    to_image_space(p, x, at);
    double u = at[0] / p->size[0], v = at[1] / p->size[1];
    if (!(u >= 0 && u <= 1 && v >= 0 && v <= 1 && at[2] >= 0))
        return 0;
    if (p->first) {
        size_t i = (size_t)(at[0] / p->cell), j = (size_t)(at[1] / p->cell);
        i = i < p->cells[0] ? i : p->cells[0] - 1;
        j = j < p->cells[1] ? j : p->cells[1] - 1;
        /* A particle's rock begins half a spacing before its centre. */
        if (at[2] > (double)p->first[j * p->cells[0] + i] - p->h / 2 + p->depth)
            return 0;
    }
    return sample(p, u, v);
}
