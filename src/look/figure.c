#include "look/figure.h"

#include <math.h>

#include "base/vector.h"
#include "field/light.h"
#include "render/develop.h"
#include "render/person.h"

enum { STEPS = 48 };
static const double TALL = 1.85, WIDE = 0.45; /* m: a cylinder that contains the person */

/* Position and direction of the person. */
struct figure {
    double at[3], turn;
};

static double distance_to(const struct person_part *p, const double x[3])
{
    double d[3], along[3];
    minus3(x, p->a, d);
    if (p->rb < 0) {
        double once[3], twice[3];
        for (int k = 0; k < 3; k++) {
            once[k] = d[k] / (p->ra * p->stretch[k]);
            twice[k] = once[k] / (p->ra * p->stretch[k]);
        }
        const double k0 = sqrt(dot3(once, once)), k1 = sqrt(dot3(twice, twice));
        return k1 > 0 ? k0 * (k0 - 1) / k1 : -p->ra;
    }
    minus3(p->b, p->a, along);
    const double t = fmin(fmax(dot3(d, along) / dot3(along, along), 0), 1);
    for (int k = 0; k < 3; k++)
        d[k] -= t * along[k];
    return sqrt(dot3(d, d)) - (p->ra + t * (p->rb - p->ra));
}

/* The distance of a point in the world to the nearest part. */
static double distance(const struct figure *f, const double world[3], const struct person_part **part)
{
    double d[3], x[3], least = HUGE_VAL;
    const double c = cos(f->turn), s = sin(f->turn);
    minus3(world, f->at, d);
    x[0] = c * d[0] + s * d[1];
    x[1] = -s * d[0] + c * d[1];
    x[2] = d[2];
    for (int i = 0; i < PERSON_PARTS; i++) {
        const double to = distance_to(&person_part[i], x);
        if (to < least) {
            least = to;
            *part = &person_part[i];
        }
    }
    return least;
}

/* Does the ray meet the person before the distance `most`? By sphere tracing. */
static bool meets(const struct figure *f, const double from[3], const double unit[3], double first,
                  double most, double x[3], const struct person_part **part)
{
    double t = first;
    for (int i = 0; i < STEPS && t < most; i++) {
        for (int k = 0; k < 3; k++)
            x[k] = from[k] + t * unit[k];
        const double d = distance(f, x, part);
        if (d < 0.004)
            return true;
        t += fmax(d, 0.003);
    }
    return false;
}

static size_t pixel_at(const struct shot *s, double x, double y)
{
    return (size_t)y * (size_t)s->camera.width + (size_t)x;
}

/* Is the place visible, without rock in its pixel? */
static bool is_open(const struct shot *s, double x, double y, double z)
{
    const double at[3] = {x, y, z};
    double px[2];
    return camera_project(&s->camera, at, px) && px[0] >= 0 && px[1] >= 0 && px[0] < s->camera.width &&
           px[1] < s->camera.height && s->depth[pixel_at(s, px[0], px[1])] > 1e9F;
}

/* Searches from the middle of the domain towards the camera, slightly to the side, for the first place with level ground one step around. */
static bool find_place(const struct job *job, const struct shot *s, struct figure *f)
{
    const double *size = job->domain.size_m, *eye = s->camera.eye,
                 span = fmax(fmax(size[0], size[1]), size[2]);
    double towards[2] = {eye[0] - 0.5 * size[0], eye[1] - 0.5 * size[1]};
    const double length = hypot(towards[0], towards[1]);
    if (!(length > 0) || eye[2] <= 0)
        return false;
    f->turn = atan2(towards[1], towards[0]) + 1;
    for (double t = 0; t < length - 1; t += 0.01 * span) {
        const double x = 0.5 * size[0] + (t * towards[0] - 0.14 * span * towards[1]) / length,
                     y = 0.5 * size[1] + (t * towards[1] + 0.14 * span * towards[0]) / length;
        bool open = is_open(s, x, y, TALL);
        for (int k = 0; k < 8 && open; k++)
            open = is_open(s, x + 0.9 * cos(k * 0.785398), y + 0.9 * sin(k * 0.785398), 0.01);
        if (open) {
            f->at[0] = x;
            f->at[1] = y;
            return true;
        }
    }
    return false;
}

/* The pixels that body and shadow can cover: x0, y0, x1, y1. */
static void bounds(const struct shot *s, const struct figure *f, const double sun[3], int out[4])
{
    const double shadow = TALL / fmax(sun[2], 0.05);
    double low[2] = {HUGE_VAL, HUGE_VAL}, high[2] = {-HUGE_VAL, -HUGE_VAL}, px[2];
    for (int corner = 0; corner < 16; corner++) {
        const double along = corner & 8 ? shadow : 0;
        const double x[3] = {f->at[0] + (corner & 1 ? WIDE : -WIDE) - along * sun[0],
                             f->at[1] + (corner & 2 ? WIDE : -WIDE) - along * sun[1], corner & 4 ? TALL : 0};
        if (!camera_project(&s->camera, x, px))
            continue;
        for (int a = 0; a < 2; a++) {
            low[a] = fmin(low[a], px[a]);
            high[a] = fmax(high[a], px[a]);
        }
    }
    out[0] = (int)fmin(fmax(low[0], 0), s->camera.width);
    out[1] = (int)fmin(fmax(low[1], 0), s->camera.height);
    out[2] = (int)fmin(fmax(high[0] + 1, 0), s->camera.width);
    out[3] = (int)fmin(fmax(high[1] + 1, 0), s->camera.height);
}

static void shade(const struct figure *f, const struct light *light, const double x[3],
                  const struct person_part *part, unsigned char rgb[3])
{
    const struct person_part *other;
    double n[3], linear[3], up;
    for (int k = 0; k < 3; k++) {
        double a[3] = {x[0], x[1], x[2]}, b[3] = {x[0], x[1], x[2]};
        a[k] += 0.005;
        b[k] -= 0.005;
        n[k] = distance(f, a, &other) - distance(f, b, &other);
    }
    const double length = fmax(sqrt(dot3(n, n)), 1e-9), sun = fmax(dot3(n, light->sun) / length, 0);
    up = 0.5 + 0.5 * n[2] / length;
    for (int k = 0; k < 3; k++)
        linear[k] = part->rgb[k] *
                    (sun * light->sun_rgb[k] + up * light->sky_rgb[k] + (1 - up) * light->bounce_rgb[k]);
    develop_color(linear, light->exposure, rgb);
}

static void draw_pixel(struct shot *s, const struct figure *f, const struct light *light, int px, int py)
{
    const struct camera *c = &s->camera;
    const size_t i = pixel_at(s, px, py);
    const double u = (px + 0.5) / c->width * 2 - 1, v = (py + 0.5) / c->height * 2 - 1;
    const struct person_part *part = person_part;
    double unit[3], x[3], away[3];
    for (int k = 0; k < 3; k++)
        unit[k] = c->ahead[k] + u * c->right[k] + v * c->down[k];
    const double length = sqrt(dot3(unit, unit));
    for (int k = 0; k < 3; k++)
        unit[k] /= length;
    minus3(f->at, c->eye, away);
    const double far = sqrt(dot3(away, away));
    if (s->depth[i] < 1e9F) /* the rock is in front of the person */
        return;
    if (meets(f, c->eye, unit, fmax(far - 4, 0), far + 4, x, &part)) {
        shade(f, light, x, part, s->rgb + 3 * i);
    } else if (unit[2] < 0) {
        const double t = -c->eye[2] / unit[2];
        const double foot[3] = {c->eye[0] + t * unit[0], c->eye[1] + t * unit[1], 0.01};
        if (meets(f, foot, light->sun, 0.02, 8, x, &part))
            for (int k = 0; k < 3; k++)
                s->rgb[3 * i + (size_t)k] = (unsigned char)(s->rgb[3 * i + (size_t)k] * 0.6);
    }
}

void figure_draw(const struct job *job, int frame, struct shot *s)
{
    struct figure f = {0};
    const struct light light = light_of(job, frame);
    int box[4];
    if (!find_place(job, s, &f))
        return;
    bounds(s, &f, light.sun, box);
    for (int y = box[1]; y < box[3]; y++)
        for (int x = box[0]; x < box[2]; x++)
            draw_pixel(s, &f, &light, x, y);
}
