#include "render/daylight.h"

#include <math.h>

#include "base/vector.h"

static const double PI = 3.14159265358979323846;

enum { MOST_LIGHTS = 24 };

static void add_rgb(struct text *out, const double rgb[3], double scale)
{
    text_add(out, "rgb <%.5f, %.5f, %.5f>", rgb[0] * scale, rgb[1] * scale, rgb[2] * scale);
}

void daylight_begin(const struct light *light, struct text *out)
{
    /* Light without direction, which reaches hollows too: half of the ground's light and a little of the sky's. */
    double ambient[3];
    for (int i = 0; i < 3; i++)
        ambient[i] = 0.42 * light->bounce_rgb[i] + 0.10 * light->sky_rgb[i];
    text_add(out, "#declare Ambient = ");
    add_rgb(out, ambient, DAYLIGHT_SCALE);
    text_add(out, ";\n");
}

/* Evenly distributed over the upper hemisphere. */
static void direction_of(int i, int n, double d[3])
{
    double z = (i + 0.5) / n, turn = i * 2.39996322972865, level = sqrt(1 - z * z);
    d[0] = level * cos(turn);
    d[1] = level * sin(turn);
    d[2] = z;
}

/* Each patch of the sky is assigned to the nearest light. */
static void gather(const struct sky *sky, int n, double rgb[MOST_LIGHTS][3])
{
    enum { PIECES = 600 };
    for (int i = 0; i < n; i++)
        rgb[i][0] = rgb[i][1] = rgb[i][2] = 0;
    for (int p = 0; p < PIECES; p++) {
        double d[3], light[3], piece[3], best = -2;
        int nearest = 0;
        direction_of(p, PIECES, d);
        for (int i = 0; i < n; i++) {
            direction_of(i, n, light);
            if (dot3(d, light) > best) {
                best = dot3(d, light);
                nearest = i;
            }
        }
        sky_radiance(sky, d, piece);
        for (int k = 0; k < 3; k++)
            rgb[nearest][k] += piece[k] * 2 / PIECES;
    }
}

static void add_sun(const struct light *light, const struct view *view, bool soft, struct text *out)
{
    if (!(light->sun[2] > 0))
        return;
    double far = 50 * view->span, radius = far * tan(0.53 * PI / 180); /* haze doubles its width */
    text_add(out, "// the sun\nlight_source {\n    Center + %.6g * <%.8f, %.8f, %.8f>\n    color ", far,
             light->sun[0], light->sun[1], light->sun[2]);
    add_rgb(out, light->sun_rgb, DAYLIGHT_SCALE);
    text_add(out, "\n    parallel point_at Center\n");
    if (soft)
        text_add(out, "    area_light %.6g * x, %.6g * z, 5, 5 adaptive 1 jitter circular orient\n", radius,
                 radius);
    text_add(out, "}\n");
}

/* Radiance of a chromaticity that the functions Sky_Y, Sky_x, Sky_y give: a row of Rec. 709 from XYZ. */
static void add_sky_channel(const char *name, const double m[3], double brightest, struct text *out)
{
    text_add(
        out,
        "#declare Sky_%s = function(x, y, z) {\n    min(0.9999, max(0, Sky_Y(x, y, z) * (%.7f * Sky_x(x, y, z) + %.7f * Sky_y(x, y, z) +\n        %.7f * (1 - Sky_x(x, y, z) - Sky_y(x, y, z))) / Sky_y(x, y, z) / %.6f))\n}\n",
        name, m[0], m[1], m[2], brightest);
}

static void add_sky(const struct light *light, struct text *out)
{
    static const char *const name[3] = {"Y", "x", "y"}, *const channel[3] = {"Red", "Green", "Blue"};
    static const double rgb[3][3] = {{3.2404542, -1.5371385, -0.4985314},
                                     {-0.9692660, 1.8760108, 0.0415560},
                                     {0.0556434, -0.2040259, 1.0572252}};
    const struct sky *s = &light->sky;
    /* Next to the sun the sky is brighter than this, but white in any picture. */
    const double brightest =
        8 * fmax(fmax(light->sky_rgb[0], light->sky_rgb[1]), fmax(light->sky_rgb[2], 1e-6));
    double theta = PI / 2 - s->lift, level = fmax(hypot(s->sun[0], s->sun[1]), 1e-9);
    text_add(
        out,
        "// the sky's radiance: Perez' function with Preetham's coefficients, as the lights have it\n"
        "#declare Sky_Up = function(x, y, z) { max(z / sqrt(x * x + y * y + z * z), 0.01) }\n"
        "#declare Sky_Near = function(x, y, z) {\n    max(-1, min(1, (%.8f * x + %.8f * y + %.8f * z) / sqrt(x * x + y * y + z * z)))\n}\n",
        s->sun[0] / level * cos(s->lift), s->sun[1] / level * cos(s->lift), sin(s->lift));
    for (int i = 0; i < 3; i++) {
        const double *c = s->perez[i];
        double overhead =
            (1 + c[0] * exp(c[1])) * (1 + c[2] * exp(c[3] * theta) + c[4] * cos(theta) * cos(theta));
        double scale = s->zenith[i] / overhead * (i == 0 ? SKY_PER_KCD * s->strength : 1);
        text_add(
            out,
            "#declare Sky_%s = function(x, y, z) {\n    %.9g * (1 + %.8g * exp(%.8g / Sky_Up(x, y, z))) *\n        (1 + %.8g * exp(%.8g * acos(Sky_Near(x, y, z))) + %.8g * pow(Sky_Near(x, y, z), 2))\n}\n",
            name[i], scale, c[0], c[1], c[2], c[3], c[4]);
    }
    for (int i = 0; i < 3; i++)
        add_sky_channel(channel[i], rgb[i], brightest, out);
    text_add(out, "sky_sphere {\n    pigment {\n        average\n        pigment_map {\n");
    for (int i = 0; i < 3; i++)
        text_add(
            out,
            "            [1 function { Sky_%s(x, y, z) } color_map { [0 rgb 0] [1 rgb <%g, %g, %g>] }]\n",
            channel[i], i == 0 ? 3 * brightest * DAYLIGHT_SCALE : 0,
            i == 1 ? 3 * brightest * DAYLIGHT_SCALE : 0, i == 2 ? 3 * brightest * DAYLIGHT_SCALE : 0);
    /* Thin high cloud, stretched sideways and lit by sun and sky. */
    double cloud[3];
    for (int i = 0; i < 3; i++)
        cloud[i] = (0.28 * light->sun_rgb[i] + light->sky_rgb[i]) * DAYLIGHT_SCALE;
    text_add(
        out,
        "        }\n    }\n    pigment {\n        wrinkles\n        turbulence 0.45\n        octaves 5\n        color_map {\n"
        "            [0.70 rgbt <%.5f, %.5f, %.5f, 1>]\n            [1.00 rgbt <%.5f, %.5f, %.5f, 0.55>]\n        }\n"
        "        scale <0.8, 0.8, 0.11>\n    }\n}\n",
        cloud[0], cloud[1], cloud[2], cloud[0], cloud[1], cloud[2]);
}

/* Kilometres of haze, thinner with height, so that the horizon is soft. */
static void add_haze(const struct light *light, struct text *out)
{
    enum { AROUND = 12 };
    double haze[3] = {0, 0, 0};
    for (int i = 0; i < AROUND; i++) {
        const double a = 2 * PI * i / AROUND,
                     d[3] = {0.9877 * cos(a), 0.9877 * sin(a), 0.1564}; /* 9 degrees up */
        double rgb[3];
        sky_radiance(&light->sky, d, rgb);
        for (int k = 0; k < 3; k++)
            haze[k] += rgb[k] / AROUND;
    }
    text_add(out, "fog { fog_type 2 up z distance 9000 fog_offset 0 fog_alt 350 color ");
    add_rgb(out, haze, 0.92 * DAYLIGHT_SCALE);
    text_add(out, " }\n");
}

void daylight_write(const struct light *light, const struct view *view, int n, bool soft, struct text *out)
{
    double rgb[MOST_LIGHTS][3], half[3];
    n = n < MOST_LIGHTS ? n : MOST_LIGHTS;
    add_sun(light, view, soft, out);
    gather(&light->sky, n, rgb);
    for (int i = 0; i < n; i++) {
        double d[3];
        direction_of(i, n, d);
        text_add(out, "light_source { Center + %.6g * <%.5f, %.5f, %.5f> color ", 50 * view->span, d[0], d[1],
                 d[2]);
        add_rgb(out, rgb[i], DAYLIGHT_SCALE);
        /* A single light low in the sky would cast a long shadow, which an entire sky does not. */
        text_add(out, " parallel point_at Center%s }\n", n < 12 && d[2] < 0.6 ? " shadowless" : "");
    }
    for (int k = 0; k < 3; k++)
        half[k] = 0.58 * light->bounce_rgb[k];
    text_add(out, "light_source { Center - %.6g * z color ", 50 * view->span);
    add_rgb(out, half, DAYLIGHT_SCALE);
    text_add(out, " parallel point_at Center shadowless }\n");
    add_sky(light, out);
    add_haze(light, out);
}
