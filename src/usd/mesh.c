/* The surface of the rock as a USD mesh. */
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "output/axes.h"
#include "usd/usd.h"

/* The attributes of every mesh; those of values.def follow. */
enum { EXTENT, COUNTS, INDICES, NORMALS, POINTS, COLOR, LAYER, VELOCITIES, OWN };
static const struct usd_attribute own[OWN] = {
    [EXTENT] = {"extent", "float3[]", USD_VEC3F, 12, ""},
    [COUNTS] = {"faceVertexCounts", "int[]", USD_INT, 4, ""},
    [INDICES] = {"faceVertexIndices", "int[]", USD_INT, 4, ""},
    [NORMALS] = {"normals", "normal3f[]", USD_VEC3F, 12, "vertex"},
    [POINTS] = {"points", "point3f[]", USD_VEC3F, 12, ""},
    [COLOR] = {"primvars:displayColor", "color3f[]", USD_VEC3F, 12, "vertex"},
    [LAYER] = {"primvars:layer", "int[]", USD_INT, 4, "vertex"},
    [VELOCITIES] = {"velocities", "vector3f[]", USD_VEC3F, 12, ""}};

/* which[i]: the index in `own` of attribute i, or OWN plus the index of its value. */
static void make_prim(const char *const *value, size_t n, bool moves, struct usd_prim *out, int *which)
{
    *out = (struct usd_prim){.name = "surface", .type = "Mesh", .folder = "mesh"};
    for (int i = 0; i < OWN; i++)
        if (moves || i != VELOCITIES)
            usd_prim_add(out, which, own[i], i);
    for (size_t v = 0; v < n; v++)
        usd_prim_add(out, which, usd_primvar(value_of_name(value[v])), OWN + (int)v);
}

void usd_mesh_prim(const char *const *value, size_t n, bool moves, struct usd_prim *out)
{
    int which[USD_ATTRIBUTES_MAX];
    make_prim(value, n, moves, out, which);
}

/* The arrays in the file's axes. */
struct arrays {
    float *points, *normals, *velocities, extent[2][3];
    int32_t *counts;
};

static void arrays_free(struct arrays *a)
{
    free(a->points);
    free(a->normals);
    free(a->velocities);
    free(a->counts);
}

static status arrays_of(const struct mesh_file *f, struct arrays *a)
{
    static const char what[] = "a mesh's arrays";
    status st = OK;
    const size_t n = f->n_vertices;
    TRY(memory_alloc(n, 3 * sizeof(float), what, &a->points));
    TRY(memory_alloc(n, 3 * sizeof(float), what, &a->normals));
    TRY(memory_alloc(f->n_triangles, sizeof *a->counts, what, &a->counts));
    if (f->velocity)
        TRY(memory_alloc(n, 3 * sizeof(float), what, &a->velocities));
    for (size_t i = 0; i < f->n_triangles; i++)
        a->counts[i] = 3;
    for (size_t i = 0; i < n; i++) {
        axes_turn(f->vertex + 3 * i, f->up, a->points + 3 * i);
        axes_turn(f->normal + 3 * i, f->up, a->normals + 3 * i);
        if (f->velocity)
            axes_turn((const float[3]){f->velocity[i], f->velocity[n + i], f->velocity[2 * n + i]}, f->up,
                      a->velocities + 3 * i);
        for (size_t c = 0; c < 3; c++) {
            const float x = a->points[3 * i + c];
            a->extent[0][c] = i == 0 || x < a->extent[0][c] ? x : a->extent[0][c];
            a->extent[1][c] = i == 0 || x > a->extent[1][c] ? x : a->extent[1][c];
        }
    }
done:
    return st;
}

status usd_mesh(const struct mesh_file *f, int frame, double fps, struct draft *out)
{
    status st = OK;
    struct arrays a = {0};
    struct usd_prim prim;
    int which[USD_ATTRIBUTES_MAX];
    struct usd_items items[USD_ATTRIBUTES_MAX];
    const size_t n = f->n_vertices;
    make_prim(f->value_name, f->n_values, f->velocity != NULL, &prim, which);
    TRY(arrays_of(f, &a));
    const struct usd_items mine[OWN] = {
        [EXTENT] = {.at = a.extent, .n = n ? 2 : 0}, [COUNTS] = {.at = a.counts, .n = f->n_triangles},
        [NORMALS] = {.at = a.normals, .n = n},       [INDICES] = {.at = f->triangle, .n = 3 * f->n_triangles},
        [POINTS] = {.at = a.points, .n = n},         [COLOR] = {.at = f->color, .n = n},
        [LAYER] = {.at = f->layer, .n = n},          [VELOCITIES] = {.at = a.velocities, .n = n},
    };
    for (size_t i = 0; i < prim.n; i++)
        items[i] = which[i] < OWN ? mine[which[i]]
                                  : (struct usd_items){.at = f->value + (size_t)(which[i] - OWN) * n, .n = n};
    TRY(usd_crate(&prim, items, f->up, frame, fps, out));
done:
    arrays_free(&a);
    return st;
}
