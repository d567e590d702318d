#include <math.h>
#include <stdio.h>
#include <string.h>

#include "base/vector.h"
#include "usd/text.h"
#include "usd/usd.h"

/* Adds the value of an attribute in one frame. */
typedef void value_at(struct text *t, const struct usd_light *light);

static void add_color(struct text *t, const double rgb[3])
{
    double bright = luminance3(rgb), hue[3];
    for (int i = 0; i < 3; i++)
        hue[i] = bright > 0 ? rgb[i] / bright : 1;
    usd_add_vector(t, hue, 3);
}

static void sun_color(struct text *t, const struct usd_light *l)
{
    add_color(t, l->sun);
}

/* Irradiance: pi times the radiance that a white surface reflects. */
static void sun_intensity(struct text *t, const struct usd_light *l)
{
    usd_add_number(t, 3.14159265358979323846 * luminance3(l->sun));
}

static void sun_stands(struct text *t, const struct usd_light *l)
{
    usd_add_matrix(t, l->to_world);
}

static void sky_color(struct text *t, const struct usd_light *l)
{
    add_color(t, l->sky);
}

static void sky_intensity(struct text *t, const struct usd_light *l)
{
    usd_add_number(t, luminance3(l->sky));
}

static void add_attribute(struct text *t, const struct usd_sequence *s, const char *name, value_at *value)
{
    text_add(t, "            %s", name);
    if (s->n_lights == 1) {
        text_add(t, " = ");
        value(t, &s->light[0]);
        text_add(t, "\n");
        return;
    }
    text_add(t, ".timeSamples = {\n");
    for (size_t i = 0; i < s->n_lights; i++) {
        text_add(t, "                %d: ", s->light[i].frame);
        value(t, &s->light[i]);
        text_add(t, ",\n");
    }
    text_add(t, "            }\n");
}

void usd_lights(const struct usd_sequence *s, struct text *t)
{
    text_add(t, "\n    def Scope \"lights\"\n    {\n        def DistantLight \"sun\"\n        {\n"
                "            float inputs:angle = 0.53\n");
    add_attribute(t, s, "color3f inputs:color", sun_color);
    add_attribute(t, s, "float inputs:intensity", sun_intensity);
    text_add(t, "            bool inputs:normalize = true\n");
    add_attribute(t, s, "matrix4d xformOp:transform", sun_stands);
    text_add(t, "            uniform token[] xformOpOrder = [\"xformOp:transform\"]\n        }\n\n"
                "        def DomeLight \"sky\"\n        {\n");
    add_attribute(t, s, "color3f inputs:color", sky_color);
    add_attribute(t, s, "float inputs:intensity", sky_intensity);
    text_add(t, "        }\n    }\n");
}
