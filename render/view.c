#include "render/view.h"

#include <math.h>

#include "base/vector.h"

/* The share of the height of the lowest line of sight that ground may take. */
static const double CLEAR = 0.4;

double view_outside(const struct view *v, double x, double y)
{
    double dx = fmax(fmax(-x, x - v->size[0]), 0), dy = fmax(fmax(-y, y - v->size[1]), 0);
    return hypot(dx, dy);
}

bool view_leaves_open(const struct view *v, double x, double y, double top)
{
    return top <= v->slope * view_outside(v, x, y);
}

double view_pixel(const struct view *v, const struct camera *c)
{
    double above = fmax(fmax(-c->eye[2], c->eye[2] - v->size[2]), 0),
           away = fmax(hypot(view_outside(v, c->eye[0], c->eye[1]), above), 0.02 * v->span);
    return away * 2 * sqrt(dot3(c->right, c->right)) / c->width;
}

static double slope_below(const struct view *v, const struct camera *c, double slope)
{
    double away = view_outside(v, c->eye[0], c->eye[1]);
    return away > 0 ? fmin(slope, CLEAR * fmax(c->eye[2], 0) / away) : slope;
}

struct view view_of(const struct job *job, const struct camera *camera, size_t n_cameras)
{
    const double *size = job->domain.size_m;
    struct view v = {.size = {size[0], size[1], size[2]}, .pixel = INFINITY, .slope = 0.2};
    v.span = fmax(fmax(size[0], size[1]), size[2]);
    for (size_t i = 0; i < n_cameras; i++) {
        const struct camera *c = &camera[i];
        v.pixel = fmin(v.pixel, view_pixel(&v, c));
        v.slope = slope_below(&v, c, v.slope);
    }
    for (size_t i = 0; i < job->n_cameras; i++)
        for (int f = job->frames.first; f <= job->frames.last; f++) {
            const struct camera c = camera_of(&job->cameras[i], f);
            v.slope = slope_below(&v, &c, v.slope);
        }
    return v;
}

/* Are all corners of the box within this share of the camera's film? */
static bool holds(const double size[3], const struct camera *c, double share)
{
    double wide = dot3(c->right, c->right), high = dot3(c->down, c->down);
    for (int corner = 0; corner < 8; corner++) {
        double d[3];
        for (int k = 0; k < 3; k++)
            d[k] = (corner >> k & 1 ? size[k] : 0) - c->eye[k];
        double w = dot3(d, c->ahead);
        if (w <= 0 || fabs(dot3(d, c->right) / wide) > share * w || fabs(dot3(d, c->down) / high) > share * w)
            return false;
    }
    return true;
}

struct camera view_around(const struct job *job, double azimuth_deg, double elevation_deg, int width,
                          int height)
{
    const double film = 18.0 / 35, *size = job->domain.size_m;
    double target[3], distance = 0;
    for (int k = 0; k < 3; k++) {
        target[k] = 0.5 * size[k];
        distance = fmax(distance, 0.5 * size[k]);
    }
    /* The distance is the same for the whole orbit, so that the rock does not change its size. Rock rarely fills its box. */
    for (int azimuth = 0; azimuth < 360; azimuth += 5)
        for (;;) {
            struct camera c = camera_orbit(target, distance, azimuth, elevation_deg, film, width, height);
            if (holds(size, &c, 0.96))
                break;
            distance *= 1.01;
        }
    return camera_orbit(target, distance, azimuth_deg, elevation_deg, film, width, height);
}

struct camera view_orbit(const struct job *job, double azimuth_deg, int width, int height)
{
    return view_around(job, azimuth_deg, 9, width, height);
}
