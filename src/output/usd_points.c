/* The rock's surface as USD points. */
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "output/axes.h"
#include "output/usd.h"
#include "output/usd_crate.h"

enum { EXTENT, IDS, NORMALS, POINTS, COLOR, LAYER, STRESS, VIABILITY, VON_MISES, WIDTHS, ATTRIBUTES };

const struct usd_prim usd_points_prim = {
    .name = "points",
    .type = "Points",
    .folder = "points",
    .n = ATTRIBUTES,
    .attribute = {[EXTENT] = {"extent", "float3[]", USD_VEC3F, 12, ""},
                  [IDS] = {"ids", "int64[]", USD_INT64, 8, ""},
                  [NORMALS] = {"normals", "normal3f[]", USD_VEC3F, 12, "vertex"},
                  [POINTS] = {"points", "point3f[]", USD_VEC3F, 12, ""},
                  [COLOR] = {"primvars:displayColor", "color3f[]", USD_VEC3F, 12, "vertex"},
                  [LAYER] = {"primvars:layer", "int[]", USD_INT, 4, "vertex"},
                  [STRESS] = {"primvars:stress", "float[]", USD_FLOAT, 4, "vertex"},
                  [VIABILITY] = {"primvars:viability", "float[]", USD_FLOAT, 4, "vertex"},
                  [VON_MISES] = {"primvars:von_mises", "float[]", USD_FLOAT, 4, "vertex"},
                  [WIDTHS] = {"widths", "float[]", USD_FLOAT, 4, "constant"}}};

/* Values of the surface's particles, as the file has them. */
struct skin {
    size_t n;
    float *points, *normals, *color; /* [n][3] */
    float *stress, *von_mises, *viability;
    int32_t *layer;
    int64_t *ids;
    float extent[2][3], width;
};

static void skin_free(struct skin *s)
{
    free(s->points);
    free(s->normals);
    free(s->color);
    free(s->stress);
    free(s->von_mises);
    free(s->viability);
    free(s->layer);
    free(s->ids);
}

static bool on_surface(const struct rock *rock, size_t i)
{
    const float *n = rock->N + 4 * i;
    return n[0] != 0 || n[1] != 0 || n[2] != 0;
}

static void take(const struct rock *rock, const struct vdb_options *o, size_t i, struct skin *s, size_t k)
{
    static const float grey[3] = {0.5F, 0.5F, 0.5F};
    const bool colored = rock->layer && o->color && rock->layer[i] < o->n_colors;
    axes_turn(rock->P + 4 * i, o->up, s->points + 3 * k);
    axes_turn(rock->N + 4 * i, o->up, s->normals + 3 * k);
    memcpy(s->color + 3 * k, colored ? o->color[rock->layer[i]] : grey, 3 * sizeof(float));
    s->stress[k] = rock->stress ? rock->stress[i] : 0;
    s->von_mises[k] = rock->von_mises ? rock->von_mises[i] : 0;
    s->viability[k] = rock->viability ? rock->viability[i] : 1;
    s->layer[k] = rock->layer ? (int32_t)rock->layer[i] : 0;
    s->ids[k] = rock->id ? (int64_t)rock->id[i] : (int64_t)i;
    for (int a = 0; a < 3; a++) {
        const float x = s->points[3 * k + (size_t)a], r = s->width / 2;
        s->extent[0][a] = k == 0 || x - r < s->extent[0][a] ? x - r : s->extent[0][a];
        s->extent[1][a] = k == 0 || x + r > s->extent[1][a] ? x + r : s->extent[1][a];
    }
}

static status skin_of(const struct rock *rock, const struct vdb_options *o, struct skin *s)
{
    static const char what[] = "the surface's points";
    status st = OK;
    size_t n = 0, k = 0;
    for (size_t i = 0; rock->N && i < rock->n; i++)
        n += on_surface(rock, i);
    if (n > UINT32_MAX / 2)
        return fail(E_OUTPUT,
                    "points of frame %d: %zu, more than a USD file can number here; set "
                    "output.usd.points: none",
                    o->frame, n);
    s->n = n;
    s->width = (float)o->spacing;
    TRY(memory_alloc(n, 3 * sizeof(float), what, &s->points));
    TRY(memory_alloc(n, 3 * sizeof(float), what, &s->normals));
    TRY(memory_alloc(n, 3 * sizeof(float), what, &s->color));
    TRY(memory_alloc(n, sizeof(float), what, &s->stress));
    TRY(memory_alloc(n, sizeof(float), what, &s->von_mises));
    TRY(memory_alloc(n, sizeof(float), what, &s->viability));
    TRY(memory_alloc(n, sizeof *s->layer, what, &s->layer));
    TRY(memory_alloc(n, sizeof *s->ids, what, &s->ids));
    for (size_t i = 0; n && i < rock->n; i++)
        if (on_surface(rock, i))
            take(rock, o, i, s, k++);
done:
    return st;
}

status usd_points(const struct rock *rock, const struct vdb_options *options, double fps,
                  struct vdb_bytes *out)
{
    status st = OK;
    struct skin s = {0};
    *out = (struct vdb_bytes){0};
    TRY(skin_of(rock, options, &s));
    const struct usd_items items[ATTRIBUTES] = {
        [EXTENT] = {s.extent, s.n ? 2 : 0}, [IDS] = {s.ids, s.n},
        [NORMALS] = {s.normals, s.n},       [POINTS] = {s.points, s.n},
        [COLOR] = {s.color, s.n},           [LAYER] = {s.layer, s.n},
        [STRESS] = {s.stress, s.n},         [VIABILITY] = {s.viability, s.n},
        [VON_MISES] = {s.von_mises, s.n},   [WIDTHS] = {&s.width, 1},
    };
    TRY(usd_crate(&usd_points_prim, items, options->up, options->frame, fps, out));
done:
    skin_free(&s);
    return st;
}
