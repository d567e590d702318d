/* Rocks as a USD point instancer, and the shapes that it instances. */
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "output/axes.h"
#include "usd/crate.h"
#include "usd/usd.h"

enum { EXTENT, IDS, ORIENTATIONS, POSITIONS, PROTOS, ATTRIBUTES };

const struct usd_prim usd_rocks_prim = {
    .name = "rocks",
    .type = "PointInstancer",
    .folder = "rocks",
    .n = ATTRIBUTES,
    .attribute = {[EXTENT] = {"extent", "float3[]", USD_VEC3F, 12, ""},
                  [IDS] = {"ids", "int64[]", USD_INT64, 8, ""},
                  [ORIENTATIONS] = {"orientations", "quath[]", USD_QUATH, 8, ""},
                  [POSITIONS] = {"positions", "point3f[]", USD_VEC3F, 12, ""},
                  [PROTOS] = {"protoIndices", "int[]", USD_INT, 4, ""}}};

/* i, j, k, then the real part, as halves. Rocks have the orientation of the tile. */
struct half_quaternion {
    uint16_t part[4];
};
static const struct half_quaternion NO_TURN = {{0, 0, 0, 0x3c00}};

struct piles {
    float *position, extent[2][3];
    struct half_quaternion *orient;
    int32_t *shape;
    int64_t *id;
};

static void take(const struct frame_rocks *rocks, const struct vdb_options *o, size_t i, struct piles *p)
{
    const struct rock *at = &rocks->at;
    axes_turn(at->P + 4 * i, o->up, p->position + 3 * i);
    p->orient[i] = NO_TURN;
    p->shape[i] = (int32_t)at->layer[i];
    p->id[i] = (int64_t)at->id[i];
    /* In the file's axes these corners are corners of the box, but not its lowest and highest ones. */
    for (int corner = 0; corner < 2; corner++) {
        float turned[3];
        axes_turn(rocks->box[at->layer[i]][corner], o->up, turned);
        for (size_t a = 0; a < 3; a++) {
            const float x = p->position[3 * i + a] + turned[a];
            const bool first = i == 0 && corner == 0;
            p->extent[0][a] = first || x < p->extent[0][a] ? x : p->extent[0][a];
            p->extent[1][a] = first || x > p->extent[1][a] ? x : p->extent[1][a];
        }
    }
}

status usd_rocks(const struct frame_rocks *rocks, const struct vdb_options *options, double fps,
                 struct draft *out)
{
    static const char what[] = "rocks";
    status st = OK;
    struct piles p = {0};
    const size_t n = rocks->at.n;
    TRY(memory_alloc(n, 3 * sizeof(float), what, &p.position));
    TRY(memory_alloc(n, sizeof *p.orient, what, &p.orient));
    TRY(memory_alloc(n, sizeof *p.shape, what, &p.shape));
    TRY(memory_alloc(n, sizeof *p.id, what, &p.id));
    for (size_t i = 0; i < n; i++)
        take(rocks, options, i, &p);
    const struct usd_items items[ATTRIBUTES] = {
        [EXTENT] = {.at = p.extent, .n = n ? 2 : 0}, [IDS] = {.at = p.id, .n = n},
        [ORIENTATIONS] = {.at = p.orient, .n = n},   [POSITIONS] = {.at = p.position, .n = n},
        [PROTOS] = {.at = p.shape, .n = n},
    };
    TRY(usd_crate(&usd_rocks_prim, items, options->up, options->frame, fps, out));
done:
    free(p.position);
    free(p.orient);
    free(p.shape);
    free(p.id);
    return st;
}

/* ---- shapes */

static void add_vectors(struct text *t, const char *type_and_name, const float *v, size_t n, int up)
{
    text_add(t, "        %s = [", type_and_name);
    for (size_t i = 0; i < n; i++) {
        float turned[3];
        axes_turn(v + 3 * i, up, turned);
        text_add(t, "%s(%.6g, %.6g, %.6g)", i ? ", " : "", (double)turned[0], (double)turned[1],
                 (double)turned[2]);
    }
    text_add(t, "]");
}

static void add_shape(struct text *t, const struct usd_shapes *s, size_t k)
{
    const struct usd_shape *shape = &s->shape[k];
    float low[3], high[3];
    for (size_t a = 0; a < 3; a++)
        low[a] = high[a] = shape->vertex[a];
    for (size_t i = 1; i < shape->n_vertices; i++)
        for (size_t a = 0; a < 3; a++) {
            const float x = shape->vertex[3 * i + a];
            low[a] = x < low[a] ? x : low[a];
            high[a] = x > high[a] ? x : high[a];
        }
    if (s->up == OUTPUT_UP_Y) { /* the axis that changes its sign swaps lowest and highest */
        const float swapped = low[1];
        low[1] = high[1];
        high[1] = swapped;
    }
    float corner[2][3];
    memcpy(corner[0], low, sizeof low);
    memcpy(corner[1], high, sizeof high);
    text_add(t, "\n    def Mesh \"rock_%zu\"\n    {\n", k);
    add_vectors(t, "float3[] extent", corner[0], 2, s->up);
    text_add(t, "\n        int[] faceVertexCounts = [");
    for (size_t i = 0; i < s->n_triangles; i++)
        text_add(t, "%s3", i ? ", " : "");
    text_add(t, "]\n        int[] faceVertexIndices = [");
    for (size_t i = 0; i < 3 * s->n_triangles; i++)
        text_add(t, "%s%u", i ? ", " : "", (unsigned)s->triangle[i]);
    text_add(t, "]\n");
    add_vectors(t, "normal3f[] normals", shape->normal, shape->n_vertices, s->up);
    text_add(t, " (\n            interpolation = \"vertex\"\n        )\n");
    add_vectors(t, "point3f[] points", shape->vertex, shape->n_vertices, s->up);
    text_add(t, "\n        color3f[] primvars:displayColor = [(%.6g, %.6g, %.6g)]\n", (double)s->color[0],
             (double)s->color[1], (double)s->color[2]);
    text_add(t, "        uniform token subdivisionScheme = \"none\"\n    }\n");
}

void usd_shapes(const struct usd_shapes *s, struct text *t)
{
    text_add(t,
             "#usda 1.0\n(\n    defaultPrim = \"prototypes\"\n    metersPerUnit = 1\n    upAxis = \"%s\"\n)\n"
             "\ndef Scope \"prototypes\"\n{",
             s->up == OUTPUT_UP_Y ? "Y" : "Z");
    for (size_t k = 0; k < s->n; k++)
        add_shape(t, s, k);
    text_add(t, "}\n");
}
