#include "field/sky.h"

#include <math.h>

#include "base/vector.h"

static const double PI = 3.14159265358979323846;
static const double MIN_LIFT = 0.00872664626; /* half a degree */

/* Rec. 709 from XYZ; chromaticities of daylight lie inside or nearly so. */
static void rgb_of_xyz(const double xyz[3], double rgb[3])
{
    static const double m[3][3] = {{3.2404542, -1.5371385, -0.4985314},
                                   {-0.9692660, 1.8760108, 0.0415560},
                                   {0.0556434, -0.2040259, 1.0572252}};
    for (int i = 0; i < 3; i++)
        rgb[i] = fmax(dot3(m[i], xyz), 0);
}

static double perez(const double c[5], double cosine, double gamma)
{
    double along = cos(gamma);
    return (1 + c[0] * exp(c[1] / cosine)) * (1 + c[2] * exp(c[3] * gamma) + c[4] * along * along);
}

struct sky sky_make(const double sun[3], double turbidity, double strength)
{
    static const double slope[3][5] = {{0.1787, -0.3554, -0.0227, 0.1206, -0.0670},
                                       {-0.0193, -0.0665, -0.0004, -0.0641, -0.0033},
                                       {-0.0167, -0.0950, -0.0079, -0.0441, -0.0109}},
                        base[3][5] = {{-1.4630, 0.4275, 5.3251, -2.5771, 0.3703},
                                      {-0.2592, 0.0008, 0.2125, -0.8989, 0.0452},
                                      {-0.2608, 0.0092, 0.2102, -1.6537, 0.0529}},
                        overhead[2][3][4] = {{{0.00166, -0.00375, 0.00209, 0},
                                              {-0.02903, 0.06377, -0.03202, 0.00394},
                                              {0.11693, -0.21196, 0.06052, 0.25886}},
                                             {{0.00275, -0.00610, 0.00317, 0},
                                              {-0.04214, 0.08970, -0.04153, 0.00516},
                                              {0.15346, -0.26756, 0.06670, 0.26688}}};
    double elevation = asin(fmin(fmax(sun[2], -1), 1)), t = turbidity;
    struct sky s = {.sun = {sun[0], sun[1], sun[2]},
                    .lift = fmax(elevation, MIN_LIFT),
                    .strength = SKY_MEASURED * strength};
    double theta = PI / 2 - s.lift, chi = (4.0 / 9 - t / 120) * (PI - 2 * theta);
    if (elevation < 0)
        s.strength *= pow(10, elevation / (6 * PI / 180));
    for (int i = 0; i < 3; i++)
        for (int k = 0; k < 5; k++)
            s.perez[i][k] = slope[i][k] * t + base[i][k];
    s.zenith[0] = fmax((4.0453 * t - 4.9710) * tan(chi) - 0.2155 * t + 2.4192, 0.02);
    for (int i = 0; i < 2; i++) {
        double power[3] = {t * t, t, 1}, sum = 0;
        for (int k = 0; k < 3; k++) {
            const double *c = overhead[i][k];
            sum += power[k] * (((c[0] * theta + c[1]) * theta + c[2]) * theta + c[3]);
        }
        s.zenith[i + 1] = sum;
    }
    return s;
}

void sky_radiance(const struct sky *s, const double direction[3], double rgb[3])
{
    double theta = PI / 2 - s->lift, level = hypot(s->sun[0], s->sun[1]), value[3], xyz[3];
    /* The sun where the model has it. */
    const double sun[3] = {level > 0 ? s->sun[0] / level * cos(s->lift) : 0,
                           level > 0 ? s->sun[1] / level * cos(s->lift) : 0, sin(s->lift)};
    double cosine = fmax(direction[2], 0.01), gamma = acos(fmin(fmax(dot3(sun, direction), -1), 1));
    for (int i = 0; i < 3; i++)
        value[i] = s->zenith[i] * perez(s->perez[i], cosine, gamma) / perez(s->perez[i], 1, theta);
    xyz[1] = fmax(value[0], 0) * SKY_PER_KCD * s->strength;
    xyz[0] = xyz[1] * value[1] / value[2];
    xyz[2] = xyz[1] * (1 - value[1] - value[2]) / value[2];
    rgb_of_xyz(xyz, rgb);
}

void sky_light(const struct sky *s, const double normal[3], double rgb[3])
{
    enum { RINGS = 12, TURNS = 36 };
    for (int i = 0; i < 3; i++)
        rgb[i] = 0;
    /* Quadrature over patches of equal solid angle. */
    for (int ring = 0; ring < RINGS; ring++)
        for (int turn = 0; turn < TURNS; turn++) {
            double z = (ring + 0.5) / RINGS, a = 2 * PI * (turn + 0.5) / TURNS, level = sqrt(1 - z * z),
                   piece[3];
            const double d[3] = {level * cos(a), level * sin(a), z};
            double cosine = dot3(normal, d);
            if (cosine <= 0)
                continue;
            sky_radiance(s, d, piece);
            for (int i = 0; i < 3; i++)
                rgb[i] += piece[i] * cosine * 2 / (RINGS * TURNS);
        }
}

void sky_sun(const double sun[3], double turbidity, double rgb[3])
{
    /* Micrometres; klx above the air, and its colour there. */
    static const double wavelength[3] = {0.63, 0.545, 0.455}, white[3] = {1.03, 1.0, 0.94}, above = 127.5;
    double elevation = asin(fmin(fmax(sun[2], -1), 1)), degrees = elevation * 180 / PI,
           beta = 0.04608 * turbidity - 0.04586;
    for (int i = 0; i < 3; i++)
        rgb[i] = 0;
    if (elevation <= 0)
        return;
    double mass = 1 / (sin(elevation) + 0.15 * pow(3.885 + degrees, -1.253));
    for (int i = 0; i < 3; i++) {
        double rayleigh = exp(-0.008735 * pow(wavelength[i], -4.08) * mass),
               aerosol = exp(-beta * pow(wavelength[i], -1.3) * mass);
        rgb[i] = SKY_PER_KCD * above / PI * white[i] * rayleigh * aerosol;
    }
}
