#include "meshinput/repair.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/log.h"
#include "base/memory.h"

struct tidy {
    const char *path;
    struct mesh *mesh;
    struct mesh_open *open;
};

static status find_open(struct tidy *w)
{
    status st = OK;
    size_t turned = 0;
    free(w->open->edge);
    *w->open = (struct mesh_open){0};
    TRY(mesh_turn_alike(w->mesh, &turned));
    TRY(mesh_find_open(w->mesh, w->open));
    if (turned > 0)
        log_info("%s: %zu of %zu triangles were turned the other way than their neighbours: turned over",
                 w->path, turned, w->mesh->n_triangles);
done:
    return st;
}

/* Does it hold nothing, but for rounding? */
static bool is_flat(const struct mesh *mesh)
{
    double area = 0;
    for (size_t t = 0; t < mesh->n_triangles; t++)
        area += mesh_triangle_area(mesh, t);
    return fabs(mesh_volume(mesh)) <= 1e-9 * area * sqrt(area);
}

/* Faces that are there again, once for either side, cancel each other: one of them goes where that closes the surface, or where
 * nothing would be left of it. */
static status drop_twins(struct tidy *w)
{
    status st = OK;
    const bool flat = is_flat(w->mesh);
    const size_t n_triangles = w->mesh->n_triangles, n_open = w->open->n;
    uint32_t(*before)[3] = NULL;
    size_t dropped = 0;
    if (n_open == 0 && !flat)
        return OK;
    TRY(memory_alloc(n_triangles, sizeof *before, "a mesh", &before));
    memcpy(before, w->mesh->triangle, n_triangles * sizeof *before);
    TRY(mesh_drop_twins(w->mesh, &dropped));
    if (dropped == 0)
        goto done;
    TRY(find_open(w));
    if (flat || w->open->n < n_open) {
        log_info("%s: %zu of %zu triangles were there more than once: dropped", w->path, dropped,
                 n_triangles);
        goto done;
    }
    memcpy(w->mesh->triangle, before, n_triangles * sizeof *before);
    w->mesh->n_triangles = n_triangles;
    TRY(find_open(w));
done:
    free(before);
    return st;
}

status mesh_tidy(struct mesh *mesh, const char *path, double tolerance, struct mesh_open *open)
{
    status st = OK;
    size_t turned = 0;
    struct mesh_welded welded = {0};
    struct tidy whole = {path, mesh, open}, *w = &whole;
    *open = (struct mesh_open){0};
    TRY(mesh_weld(mesh));
    TRY(find_open(w));
    if (open->n > 0)
        TRY(mesh_weld_open(mesh, open, tolerance, &welded));
    if (welded.n > 0) {
        log_info(
            "%s: the surface is open along %zu edges, of which %zu corners are joined to others at most %.2g m away (up to %.2g m are)",
            path, open->n, welded.n, welded.farthest, tolerance);
        TRY(find_open(w));
    }
    TRY(drop_twins(w));
    if (mesh->n_triangles == 0) {
        st = fail(E_INPUT, "%s: every face is a point or a line", path);
        goto done;
    }
    TRY(mesh_turn_outwards(mesh, open, &turned));
    if (open->n == 0 && is_flat(mesh)) {
        st = fail(
            E_INPUT,
            "%s: its faces cancel each other: there is one for either side of each: remove the doubles (in Blender: Mesh > Clean Up > Merge by Distance, or export without both sides)",
            path);
        goto done;
    }
    if (turned > 0)
        log_info("%s: %zu of its parts were inside out: turned over", path, turned);
done:
    return st;
}
