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

/* The surface particles, and how they are written. */
struct skin {
    const struct rock *rock;
    const struct vdb_options *options;
    size_t n;
    uint32_t *at; /* [n]: their numbers in the rock */
    float extent[2][3], width;
};

/* An attribute to make of the skin: an index in `own`, or OWN plus a value. */
struct making {
    const struct skin *skin;
    int which;
};

static bool on_surface(const struct rock *rock, size_t i)
{
    const float *n = rock->N + 4 * i;
    return n[0] != 0 || n[1] != 0 || n[2] != 0;
}

static void extend(struct skin *s, const float P[4], bool first)
{
    float x[3];
    axes_turn(P, s->options->up, x);
    for (int a = 0; a < 3; a++) {
        const float low = x[a] - s->width / 2, high = x[a] + s->width / 2;
        s->extent[0][a] = first || low < s->extent[0][a] ? low : s->extent[0][a];
        s->extent[1][a] = first || high > s->extent[1][a] ? high : s->extent[1][a];
    }
}

static status skin_of(const struct rock *rock, const struct vdb_options *o, struct skin *s)
{
    status st = OK;
    size_t n = 0;
    for (size_t i = 0; rock->N && i < rock->n; i++)
        n += on_surface(rock, i);
    if (n > UINT32_MAX / 2)
        return fail(E_OUTPUT,
                    "points of frame %d: %zu points are too many for a USD file; set output.usd.points: none",
                    o->frame, n);
    *s = (struct skin){.rock = rock, .options = o, .width = (float)o->spacing};
    TRY(memory_alloc(n, sizeof *s->at, "the surface's points", &s->at));
    for (size_t i = 0; s->n < n; i++)
        if (on_surface(rock, i)) {
            extend(s, rock->P + 4 * i, s->n == 0);
            s->at[s->n++] = (uint32_t)i;
        }
done:
    return st;
}

static void color_of(const struct skin *s, size_t i, float out[3])
{
    static const float grey[3] = {0.5F, 0.5F, 0.5F};
    const struct vdb_options *o = s->options;
    const bool colored = s->rock->layer && o->color && s->rock->layer[i] < o->n_colors;
    memcpy(out, colored ? o->color[s->rock->layer[i]] : grey, 3 * sizeof *out);
}

/* Vectors of the rock in the file's axes; 0 if the rock does not have the field. */
static void make_vectors(const struct skin *s, const float *from, const uint32_t *at, size_t n, float *out)
{
    memset(out, 0, 3 * n * sizeof *out);
    for (size_t k = 0; from && k < n; k++)
        axes_turn(from + 4 * (size_t)at[k], s->options->up, out + 3 * k);
}

static void make(const void *user, size_t first, size_t n, void *out)
{
    const struct making *m = user;
    const struct skin *s = m->skin;
    const struct rock *rock = s->rock;
    const uint32_t *at = s->at + first;
    switch (m->which) {
    case IDS:
        for (size_t k = 0; k < n; k++)
            ((int64_t *)out)[k] = rock->id ? (int64_t)rock->id[at[k]] : (int64_t)at[k];
        break;
    case NORMALS:
        make_vectors(s, rock->N, at, n, out);
        break;
    case POINTS:
        make_vectors(s, rock->P, at, n, out);
        break;
    case VELOCITIES:
        make_vectors(s, rock->v, at, n, out);
        break;
    case COLOR:
        for (size_t k = 0; k < n; k++)
            color_of(s, at[k], (float *)out + 3 * k);
        break;
    default: { /* values are words */
        const uint32_t *from = rock->field[value_field[m->which - OWN]];
        for (size_t k = 0; k < n; k++)
            ((uint32_t *)out)[k] = from ? from[at[k]] : 0;
    }
    }
}

status usd_points(const struct rock *rock, const struct vdb_options *options, double fps, struct draft *out)
{
    status st = OK;
    struct skin s = {0};
    struct usd_items items[USD_ATTRIBUTES_MAX];
    struct making making[USD_ATTRIBUTES_MAX];
    TRY(skin_of(rock, options, &s));
    const struct usd_prim *const points = usd_points_prim(options->moves);
    for (size_t i = 0; i < points->n; i++) {
        making[i] = (struct making){&s, which[options->moves][i]};
        items[i] = making[i].which == EXTENT ? (struct usd_items){.at = s.extent, .n = s.n ? 2 : 0}
                   : making[i].which == WIDTHS
                       ? (struct usd_items){.at = &s.width, .n = 1}
                       : (struct usd_items){.n = s.n, .make = make, .user = &making[i]};
    }
    TRY(usd_crate(points, items, options->up, options->frame, fps, out));
done:
    free(s.at);
    return st;
}
