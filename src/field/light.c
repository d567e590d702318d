#include "field/light.h"

#include <math.h>

#include "base/vector.h"
#include "field/camera.h"
#include "shared/params.h"

static const double DEGREE = 3.14159265358979323846 / 180;

static const double GROUND[3] = {(double)GROUND_R, (double)GROUND_G, (double)GROUND_B};

void light_direction(double azimuth_deg, double elevation_deg, double out[3])
{
    out[0] = cos(elevation_deg * DEGREE) * cos(azimuth_deg * DEGREE);
    out[1] = cos(elevation_deg * DEGREE) * sin(azimuth_deg * DEGREE);
    out[2] = sin(elevation_deg * DEGREE);
}

void light_solar(double latitude_deg, double day, double hour, double out[3])
{
    double declination = 23.45 * DEGREE * sin(2 * 180 * DEGREE * (284 + day) / 365),
           turn = 15 * DEGREE * (hour - 12), latitude = latitude_deg * DEGREE;
    out[0] = -cos(declination) * sin(turn);
    out[1] = cos(latitude) * sin(declination) - sin(latitude) * cos(declination) * cos(turn);
    out[2] = sin(latitude) * sin(declination) + cos(latitude) * cos(declination) * cos(turn);
}

/* A direction between side light, which shows relief, and light from behind the camera, which shows colours. */
static void raking(const struct job *job, double out[3])
{
    const double aside_deg = 58, elevation_deg = 30;
    double azimuth_deg = -55, best = -INFINITY;
    if (job->n_cameras) {
        const struct camera c = camera_of(&job->cameras[0], job->frames.first);
        if (hypot(c.ahead[0], c.ahead[1]) > 1e-6)
            azimuth_deg = atan2(-c.ahead[1], -c.ahead[0]) / DEGREE;
    }
    for (int side = -1; side <= 1; side += 2) {
        double d[3];
        light_direction(azimuth_deg + side * aside_deg, elevation_deg, d);
        double faces = -(d[0] * job->wind.direction[0] + d[1] * job->wind.direction[1]);
        if (faces > best) {
            best = faces;
            for (int i = 0; i < 3; i++)
                out[i] = d[i];
        }
    }
}

/* The colour of a black body, of luminance 1. Chromaticity on the Planckian locus by the cubics of Kim, Kwon, Lee and Lee (2002). */
static void black_body(double kelvin, double rgb[3])
{
    double t = 1000 / fmin(fmax(kelvin, 1667), 25000), x, y;
    x = kelvin < 4000 ? ((-0.2661239 * t - 0.2343589) * t + 0.8776956) * t + 0.179910
                      : ((-3.0258469 * t + 2.1070379) * t + 0.2226347) * t + 0.240390;
    y = kelvin < 2222   ? ((-1.1063814 * x - 1.34811020) * x + 2.18555832) * x - 0.20219683
        : kelvin < 4000 ? ((-0.9549476 * x - 1.37418593) * x + 2.09137015) * x - 0.16748867
                        : ((3.0817580 * x - 5.87338670) * x + 3.75112997) * x - 0.37001483;
    double big_x = x / y, big_z = (1 - x - y) / y;
    rgb[0] = fmax(3.2404542 * big_x - 1.5371385 - 0.4985314 * big_z, 0);
    rgb[1] = fmax(-0.9692660 * big_x + 1.8760108 + 0.0415560 * big_z, 0);
    rgb[2] = fmax(0.0556434 * big_x - 0.2040259 + 1.0572252 * big_z, 0);
}

struct light light_of(const struct job *job, double frame)
{
    const struct job_light *from = &job->light;
    static const double up[3] = {0, 0, 1};
    struct light light;
    double kelvin = curve_at(&from->temperature_K, frame), turbidity = curve_at(&from->turbidity, frame),
           ambient = curve_at(&from->ambient, frame);
    if (from->sun)
        light_direction(curve_at(&from->sun->azimuth_deg, frame), curve_at(&from->sun->elevation_deg, frame),
                        light.sun);
    else if (from->solar)
        light_solar(curve_at(&from->solar->latitude_deg, frame), curve_at(&from->solar->day_of_year, frame),
                    curve_at(&from->solar->hour, frame), light.sun);
    else
        raking(job, light.sun);
    sky_sun(light.sun, turbidity, light.sun_rgb);
    if (kelvin > 0) {
        double bright = luminance3(light.sun_rgb);
        black_body(kelvin, light.sun_rgb);
        for (int i = 0; i < 3; i++)
            light.sun_rgb[i] *= bright;
    }
    light.sky = sky_make(light.sun, turbidity, curve_at(&from->sky, frame));
    sky_light(&light.sky, up, light.sky_rgb);
    for (int i = 0; i < 3; i++) {
        light.sun_rgb[i] *= curve_at(&from->strength, frame);
        light.bounce_rgb[i] =
            ambient * GROUND[i] * (light.sun_rgb[i] * fmax(light.sun[2], 0) + light.sky_rgb[i]);
    }
    light.exposure = exp2(curve_at(&from->exposure_stops, frame));
    return light;
}

bool light_changes(const struct job *job)
{
    const struct job_light *l = &job->light;
    const struct curve *const own[] = {&l->strength, &l->temperature_K, &l->turbidity, &l->sky, &l->ambient};
    bool changes = false;
    for (size_t i = 0; i < sizeof own / sizeof *own; i++)
        changes |= own[i]->n > 1;
    if (l->sun)
        changes |= l->sun->azimuth_deg.n > 1 || l->sun->elevation_deg.n > 1;
    if (l->solar)
        changes |= l->solar->latitude_deg.n > 1 || l->solar->day_of_year.n > 1 || l->solar->hour.n > 1;
    return changes;
}
