/* The surface particles of the rock as USD points. */
#include <pthread.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "output/axes.h"
#include "usd/crate.h"
#include "usd/usd.h"

/* The attributes of all points; those of values.def follow. */
enum { EXTENT, IDS, NORMALS, POINTS, COLOR, VELOCITIES, WIDTHS, OWN };
static const struct usd_attribute own[OWN] = {
    [EXTENT] = {"extent", "float3[]", USD_VEC3F, 12, ""},
    [IDS] = {"ids", "int64[]", USD_INT64, 8, ""},
    [NORMALS] = {"normals", "normal3f[]", USD_VEC3F, 12, "vertex"},
    [POINTS] = {"points", "point3f[]", USD_VEC3F, 12, ""},
    [COLOR] = {"primvars:displayColor", "color3f[]", USD_VEC3F, 12, "vertex"},
    [VELOCITIES] = {"velocities", "vector3f[]", USD_VEC3F, 12, ""},
    [WIDTHS] = {"widths", "float[]", USD_FLOAT, 4, "constant"}};

/* The prim without [0] and with [1] velocities; which[][i] is the index in `own` of attribute i, or OWN plus its value. */
static struct usd_prim prim[2] = {{.name = "points", .type = "Points", .folder = "points"},
                                  {.name = "points", .type = "Points", .folder = "points"}};
static int which[2][USD_ATTRIBUTES_MAX];
static pthread_once_t once = PTHREAD_ONCE_INIT;

static void make_prims(void)
{
    for (int moves = 0; moves < 2; moves++) {
        for (int i = 0; i < OWN; i++)
            if (moves || i != VELOCITIES)
                usd_prim_add(&prim[moves], which[moves], own[i], i);
        for (int v = 1; v < VALUES; v++)
            if (value_table[v].where & IN_USD)
                usd_prim_add(&prim[moves], which[moves], usd_primvar((enum value_id)v), OWN + v);
    }
}

const struct usd_prim *usd_points_prim(bool moves)
{
    pthread_once(&once, make_prims);
    return &prim[moves];
}

/* The arrays of the surface particles in the file's axes. */
struct skin {
    size_t n;
    float *points, *normals, *color, *velocities; /* [n][3] */
    int64_t *ids;
    uint32_t *value[VALUES]; /* [n] words, of those that are IN_USD */
    float extent[2][3], width;
};

static void skin_free(struct skin *s)
{
    free(s->points);
    free(s->normals);
    free(s->color);
    free(s->velocities);
    free(s->ids);
    for (int v = 0; v < VALUES; v++)
        free(s->value[v]);
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
    if (s->velocities && rock->v)
        axes_turn(rock->v + 4 * i, o->up, s->velocities + 3 * k);
    memcpy(s->color + 3 * k, colored ? o->color[rock->layer[i]] : grey, 3 * sizeof(float));
    for (int v = 1; v < VALUES; v++)
        if (s->value[v] && rock->field[value_field[v]])
            s->value[v][k] = ((const uint32_t *)rock->field[value_field[v]])[i];
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
                    "points of frame %d: %zu points are too many for a USD file; set output.usd.points: none",
                    o->frame, n);
    s->n = n;
    s->width = (float)o->spacing;
    TRY(memory_alloc(n, 3 * sizeof(float), what, &s->points));
    TRY(memory_alloc(n, 3 * sizeof(float), what, &s->normals));
    TRY(memory_alloc(n, 3 * sizeof(float), what, &s->color));
    if (o->moves)
        TRY(memory_alloc(n, 3 * sizeof(float), what, &s->velocities));
    for (int v = 1; v < VALUES; v++)
        if (value_table[v].where & IN_USD)
            TRY(memory_alloc(n, sizeof(uint32_t), what, &s->value[v]));
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
    struct usd_items items[USD_ATTRIBUTES_MAX];
    *out = (struct vdb_bytes){0};
    TRY(skin_of(rock, options, &s));
    const struct usd_items mine[OWN] = {
        [EXTENT] = {s.extent, s.n ? 2 : 0}, [IDS] = {s.ids, s.n},     [NORMALS] = {s.normals, s.n},
        [POINTS] = {s.points, s.n},         [COLOR] = {s.color, s.n}, [VELOCITIES] = {s.velocities, s.n},
        [WIDTHS] = {&s.width, 1},
    };
    const struct usd_prim *const points = usd_points_prim(options->moves);
    const int *const is = which[options->moves];
    for (size_t i = 0; i < points->n; i++)
        items[i] = is[i] < OWN ? mine[is[i]] : (struct usd_items){s.value[is[i] - OWN], s.n};
    TRY(usd_crate(points, items, options->up, options->frame, fps, out));
done:
    skin_free(&s);
    return st;
}
