#include "look/shot.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "base/random.h"
#include "base/vector.h"
#include "field/light.h"
#include "render/develop.h"

/* The scene-linear radiance that 65535 means before tone mapping. */
static const double WHITE = 4;

/* ---- channels of the image */

struct found {
    const float *rgba[4], *depth, *n[3], *p[3], *value;
    const uint32_t *id; /* the value, if it is a whole number */
};

static const float *channel_of(const struct aov_image *image, const char *name)
{
    for (size_t i = 0; i < image->n_channels; i++)
        if (strcmp(image->channel[i].name, name) == 0)
            return image->channel[i].value;
    return NULL;
}

static void find(const struct aov_image *image, enum value_id show, struct found *f)
{
    static const char *const rgba[] = {"R", "G", "B", "A"}, *const n[] = {"N.X", "N.Y", "N.Z"},
                             *const p[] = {"P.X", "P.Y", "P.Z"};
    for (int c = 0; c < 4; c++)
        f->rgba[c] = channel_of(image, rgba[c]);
    for (int c = 0; c < 3; c++) {
        f->n[c] = channel_of(image, n[c]);
        f->p[c] = channel_of(image, p[c]);
    }
    f->depth = channel_of(image, "Z");
    f->value = show ? channel_of(image, value_table[show].channel[0]) : NULL;
    f->id = NULL;
    for (size_t i = 0; show && i < image->n_channels; i++)
        if (strcmp(image->channel[i].name, value_table[show].channel[0]) == 0)
            f->id = image->channel[i].id;
}

static bool is_rock(const struct found *f, size_t i)
{
    return f->depth[i] < 1e9F;
}

/* ---- grain */

/* Smooth noise from -1 to 1 with features of size 1. */
static double noise(const double x[3], uint32_t seed)
{
    int32_t low[3];
    double f[3], sum = 0;
    for (int a = 0; a < 3; a++) {
        double whole = floor(x[a]), t = x[a] - whole;
        low[a] = (int32_t)fmax(fmin(whole, 1e9), -1e9);
        f[a] = t * t * (3 - 2 * t);
    }
    for (uint32_t b = 0; b < 8; b++) {
        double weight = 1;
        for (uint32_t a = 0; a < 3; a++)
            weight *= b >> a & 1 ? f[a] : 1 - f[a];
        sum += weight *
               (double)random_float(random_hash((uint32_t)low[0] + (b & 1), (uint32_t)low[1] + (b >> 1 & 1),
                                                (uint32_t)low[2] + (b >> 2), seed));
    }
    return 2 * sum - 1;
}

/* A factor for the colour at a place; `pixel` is the size of a pixel there (m). Features are `flat` times wider than high, like beds. */
static double grain(const double x[3], double pixel, double flat)
{
    static const double wide[] = {0.2, 1, 4.5, 20};
    double factor = 1;
    for (uint32_t k = 0; k < sizeof wide / sizeof *wide; k++) {
        const double seen = fmin(fmax(wide[k] / flat / (2 * pixel) - 1, 0), 1);
        if (seen <= 0)
            continue;
        const double at[3] = {x[0] / wide[k], x[1] / wide[k], x[2] / wide[k] * flat};
        factor += 0.09 * seen * noise(at, k);
    }
    return factor;
}

/* ---- light */

static void direction(const struct camera *c, int x, int y, double out[3])
{
    const double u = (x + 0.5) / c->width * 2 - 1, v = (y + 0.5) / c->height * 2 - 1;
    for (int a = 0; a < 3; a++)
        out[a] = c->ahead[a] + u * c->right[a] + v * c->down[a];
}

/* The ground fades into the sky at distances that are large compared with the scene. */
static void haze(const struct sky *sky, double distance, double span, const double along[3], double rgb[3])
{
    const double share = 1 - exp(-distance / (10 * span));
    const double level[3] = {along[0], along[1], 0};
    double length = hypot(along[0], along[1]), far[3];
    const double unit[3] = {level[0] / fmax(length, 1e-9), level[1] / fmax(length, 1e-9), 0};
    sky_radiance(sky, unit, far);
    for (int c = 0; c < 3; c++)
        rgb[c] += share * (far[c] - rgb[c]);
}

/* The scene-linear colour of a pixel. */
static void color_of(const struct light *light, const struct camera *c, double span, const struct found *f,
                     size_t i, double rgb[3])
{
    const int x = (int)(i % (size_t)c->width), y = (int)(i / (size_t)c->width);
    const double film = 2 * sqrt(dot3(c->right, c->right)) / c->width, alpha = (double)f->rgba[3][i];
    double along[3], sky[3], at[3];
    direction(c, x, y, along);
    const double length = sqrt(dot3(along, along));
    for (int k = 0; k < 3; k++)
        rgb[k] = (double)f->rgba[k][i];
    if (is_rock(f, i)) {
        for (int k = 0; k < 3; k++)
            at[k] = (double)f->p[k][i];
        const double g = grain(at, film * (double)f->depth[i], 4);
        for (int k = 0; k < 3; k++)
            rgb[k] *= g;
    } else if (alpha > 0 && fabs(along[2]) < 1.5 * film) { /* the horizon blends ground and sky */
        haze(&light->sky, HUGE_VAL, span, along, rgb);
        return;
    } else if (alpha > 0 && along[2] < 0) {
        const double t = -c->eye[2] / along[2];
        for (int k = 0; k < 3; k++)
            at[k] = c->eye[k] + t * along[k];
        const double g = grain(at, film * t / fmax(-along[2] / length, 0.02), 1);
        for (int k = 0; k < 3; k++)
            rgb[k] *= g;
        haze(&light->sky, t * length, span, along, rgb);
    }
    if (alpha < 1) {
        for (int k = 0; k < 3; k++)
            along[k] /= length;
        sky_radiance(&light->sky, along, sky);
        for (int k = 0; k < 3; k++)
            rgb[k] += (1 - alpha) * sky[k];
    }
}

/* The colour of a value, lit from the camera, so that shapes are visible and colours match the legend. */
static void paint_value(struct shot *s, enum value_id show, struct show_range range, const struct found *f,
                        size_t i)
{
    const double scaled = (f->id ? (double)f->id[i] : (double)f->value[i]) * value_table[show].legend.scale;
    double along[3], facing = 0;
    unsigned char rgb[3];
    direction(&s->camera, (int)(i % (size_t)s->camera.width), (int)(i / (size_t)s->camera.width), along);
    for (int a = 0; a < 3; a++)
        facing -= along[a] * (double)f->n[a][i];
    facing = fmax(facing / sqrt(dot3(along, along)), 0);
    show_color(show, range, show_position(show, range, scaled), rgb);
    for (int c = 0; c < 3; c++)
        s->rgb[3 * i + (size_t)c] = (unsigned char)lrint(rgb[c] * (0.55 + 0.45 * facing));
}

/* ---- the picture */

static status develop(struct shot *s, const struct light *light, double span, const struct found *f)
{
    status st = OK;
    const size_t n = (size_t)s->camera.width * (size_t)s->camera.height;
    unsigned char *at;
    TRY(memory_alloc(6 * n + 64, 1, "a picture", &s->ppm));
    at = s->ppm;
    const size_t head = (size_t)sprintf(s->ppm, "P6\n%d %d\n65535\n", s->camera.width, s->camera.height);
    for (size_t i = 0; i < n; i++) {
        double rgb[3];
        color_of(light, &s->camera, span, f, i, rgb);
        for (size_t c = 0; c < 3; c++) {
            const long v = lrint(65535 * fmin(fmax(rgb[c] / WHITE, 0), 1));
            at[head + 6 * i + 2 * c] = (unsigned char)(v >> 8);
            at[head + 6 * i + 2 * c + 1] = (unsigned char)(v & 255);
        }
    }
    s->size = head + 6 * n;
    TRY(develop_ppm(s->ppm, &s->size, WHITE, light->exposure));
    s->rgb = at + s->size - 3 * n;
done:
    return st;
}

status shot_make(const struct job *job, int frame, const struct aov_image *image, const struct camera *camera,
                 enum value_id show, struct show_range range, struct shot *out)
{
    status st = OK;
    const struct light light = light_of(job, frame);
    const double *size = job->domain.size_m, span = fmax(fmax(size[0], size[1]), size[2]);
    const size_t n = (size_t)image->width * (size_t)image->height;
    struct found f;
    find(image, show, &f);
    *out = (struct shot){.camera = *camera};
    TRY(memory_alloc(n, sizeof *out->depth, "a picture", &out->depth));
    TRY(develop(out, &light, span, &f));
    for (size_t i = 0; i < n; i++) {
        out->depth[i] = is_rock(&f, i) ? f.depth[i] : HUGE_VALF;
        if ((f.value || f.id) && is_rock(&f, i))
            paint_value(out, show, range, &f, i);
    }
done:
    if (st != OK)
        shot_free(out);
    return st;
}

void shot_free(struct shot *s)
{
    free(s->ppm);
    free(s->depth);
    *s = (struct shot){0};
}

/* ---- lines */

/* The depth of the rock or ground in a pixel, which hides lines behind it. */
static double hidden_behind(const struct shot *s, int x, int y)
{
    const double rock = (double)s->depth[(size_t)y * (size_t)s->camera.width + (size_t)x];
    double along[3];
    direction(&s->camera, x, y, along);
    return along[2] < 0 && s->camera.eye[2] > 0 ? fmin(rock, -s->camera.eye[2] / along[2]) : rock;
}

static void dab(struct shot *s, int x, int y, double depth, double share, const unsigned char rgb[3])
{
    if (x < 0 || y < 0 || x >= s->camera.width || y >= s->camera.height || share <= 0)
        return;
    unsigned char *at = s->rgb + 3 * ((size_t)y * (size_t)s->camera.width + (size_t)x);
    if (depth > 1.002 * hidden_behind(s, x, y))
        share *= 0.22;
    for (int c = 0; c < 3; c++)
        at[c] = (unsigned char)lrint(at[c] + share * (rgb[c] - at[c]));
}

/* Clips the line at the plane of the camera. False: it is behind the camera entirely. */
static bool before_camera(const struct camera *c, double from[3], double to[3])
{
    double a[3], b[3];
    minus3(from, c->eye, a);
    minus3(to, c->eye, b);
    const double near = 1e-3, w[2] = {dot3(a, c->ahead), dot3(b, c->ahead)};
    if (w[0] < near && w[1] < near)
        return false;
    for (int k = 0; k < 3; k++) {
        const double cut = from[k] + (to[k] - from[k]) * (near - w[0]) / (w[1] - w[0]);
        if (w[0] < near)
            from[k] = cut;
        else if (w[1] < near)
            to[k] = cut;
    }
    return true;
}

void shot_line(struct shot *s, const double from[3], const double to[3], const unsigned char rgb[3])
{
    double end[2][3], px[2][2], inverse[2];
    memcpy(end[0], from, sizeof end[0]);
    memcpy(end[1], to, sizeof end[1]);
    if (!before_camera(&s->camera, end[0], end[1]))
        return;
    for (int e = 0; e < 2; e++) {
        double d[3];
        minus3(end[e], s->camera.eye, d);
        inverse[e] = 1 / fmax(dot3(d, s->camera.ahead), 1e-9);
        if (!camera_project(&s->camera, end[e], px[e]))
            return;
    }
    /* One step per pixel along the longer axis; across it, the width is distributed over three pixels. */
    const int axis = fabs(px[1][0] - px[0][0]) >= fabs(px[1][1] - px[0][1]) ? 0 : 1, across = 1 - axis;
    const int first = px[0][axis] <= px[1][axis] ? 0 : 1, last = 1 - first;
    const int most = axis == 0 ? s->camera.width : s->camera.height;
    const double length = px[last][axis] - px[first][axis];
    const int begin = (int)fmax(ceil(px[first][axis] - 0.5), 0),
              stop = (int)fmin(floor(px[last][axis] - 0.5), most - 1);
    for (int p = begin; p <= stop; p++) {
        const double t = length > 0 ? (p + 0.5 - px[first][axis]) / length : 0;
        const double side = px[first][across] + t * (px[last][across] - px[first][across]);
        const double depth = 1 / (inverse[first] + t * (inverse[last] - inverse[first]));
        for (int q = (int)floor(side - 1.25); q <= (int)floor(side + 1.25); q++) {
            const double share = fmin(1.25 - fabs(q + 0.5 - side), 1);
            dab(s, axis == 0 ? p : q, axis == 0 ? q : p, depth, 0.9 * share, rgb);
        }
    }
}
