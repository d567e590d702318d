#include "field/camera.h"

#include <math.h>
#include <string.h>

#include "base/vector.h"

static void normalize(double v[3])
{
    double length = sqrt(dot3(v, v));
    for (int i = 0; i < 3; i++)
        v[i] /= length > 0 ? length : 1;
}

static struct camera look(const double eye[3], const double target[3], double film, int width, int height)
{
    static const double up[3] = {0, 0, 1}, north[3] = {0, 1, 0};
    struct camera c = {.width = width, .height = height};
    for (int i = 0; i < 3; i++) {
        c.eye[i] = eye[i];
        c.ahead[i] = target[i] - eye[i];
    }
    normalize(c.ahead);
    /* For a camera that looks straight up or down, the top of the image is north. */
    cross3(c.ahead, fabs(c.ahead[2]) > 1 - 1e-9 ? north : up, c.right);
    normalize(c.right);
    cross3(c.ahead, c.right, c.down);
    for (int i = 0; i < 3; i++) {
        c.right[i] *= film;
        c.down[i] *= film * height / width;
    }
    return c;
}

struct camera camera_orbit(const double target[3], double distance, double azimuth_deg, double elevation_deg,
                           double film, int width, int height)
{
    const double degree = 3.14159265358979323846 / 180, level = cos(elevation_deg * degree);
    const double eye[3] = {
        target[0] + distance * level * cos(azimuth_deg * degree),
        target[1] + distance * level * sin(azimuth_deg * degree),
        target[2] + distance * sin(elevation_deg * degree),
    };
    return look(eye, target, film, width, height);
}

struct camera camera_of(const struct job_camera *camera, double frame)
{
    const struct job_orbit *o = &camera->orbit;
    double film = 0.5 * camera->aperture_mm / curve_at(&camera->focal_mm, frame), eye[3], target[3];
    int width = (int)camera->resolution[0], height = (int)camera->resolution[1];
    double distance = curve_at(&o->distance_m, frame);
    if (distance > 0) {
        track_at(&o->target_m, frame, target);
        return camera_orbit(target, distance, curve_at(&o->azimuth_deg, frame),
                            curve_at(&o->elevation_deg, frame), film, width, height);
    }
    track_at(&camera->position_m, frame, eye);
    track_at(&camera->target_m, frame, target);
    return look(eye, target, film, width, height);
}

struct camera camera_overscan(struct camera c, const int margin[2])
{
    for (int i = 0; i < 3; i++) {
        c.right[i] *= 1 + 2.0 * margin[0] / c.width;
        c.down[i] *= 1 + 2.0 * margin[1] / c.height;
    }
    c.width += 2 * margin[0];
    c.height += 2 * margin[1];
    return c;
}

bool camera_project(const struct camera *c, const double x[3], double px[2])
{
    const double d[3] = {x[0] - c->eye[0], x[1] - c->eye[1], x[2] - c->eye[2]};
    double depth = dot3(d, c->ahead);
    if (depth <= 0)
        return false;
    px[0] = 0.5 * c->width * (1 + dot3(d, c->right) / dot3(c->right, c->right) / depth);
    px[1] = 0.5 * c->height * (1 + dot3(d, c->down) / dot3(c->down, c->down) / depth);
    return true;
}

void camera_matrices(const struct camera *c, int up, double world_to_camera[16], double world_to_ndc[16])
{
    double half_width = sqrt(dot3(c->right, c->right)), half_height = sqrt(dot3(c->down, c->down));
    const double *axis[3] = {c->right, c->down, c->ahead};
    const double scale[3] = {1 / half_width, -1 / half_height, 1}; /* y is up in camera space */
    double m[16] = {0};
    for (int column = 0; column < 3; column++) {
        double a[3];
        for (int i = 0; i < 3; i++)
            a[i] = axis[column][i] * scale[column];
        /* (x, y, z) of the simulator is (x, z, -y) in y-up files. */
        double rows[3] = {a[0], up == OUTPUT_UP_Y ? a[2] : a[1], up == OUTPUT_UP_Y ? -a[1] : a[2]};
        for (int row = 0; row < 3; row++)
            m[4 * row + column] = rows[row];
        m[12 + column] = -dot3(c->eye, a);
    }
    m[15] = 1;
    memcpy(world_to_camera, m, sizeof m);
    for (int row = 0; row < 4; row++) {
        double x = m[4 * row], y = m[4 * row + 1], z = m[4 * row + 2];
        world_to_ndc[4 * row] = 0.5 * (x / half_width + z);
        world_to_ndc[4 * row + 1] = 0.5 * (z - y / half_height);
        world_to_ndc[4 * row + 2] = z;
        world_to_ndc[4 * row + 3] = z;
    }
}
