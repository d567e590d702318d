#include "meshinput/repair.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/log.h"
#include "base/memory.h"

struct repair {
    const char *path;
    struct mesh *mesh;
    struct mesh_open *open;
};

static status find_open(struct repair *w)
{
    status st = OK;
    size_t flipped = 0;
    free(w->open->edge);
    *w->open = (struct mesh_open){0};
    TRY(mesh_orient_consistently(w->mesh, &flipped));
    TRY(mesh_find_open(w->mesh, w->open));
    if (flipped > 0)
        log_info("%s: %zu of %zu triangles were oriented against their neighbours: flipped", w->path, flipped,
                 w->mesh->n_triangles);
done:
    return st;
}

/* Is its volume 0 except for rounding? */
static bool is_flat(const struct mesh *mesh)
{
    double area = 0;
    for (size_t t = 0; t < mesh->n_triangles; t++)
        area += mesh_triangle_area(mesh, t);
    return fabs(mesh_volume(mesh)) <= 1e-9 * area * sqrt(area);
}

/* Two copies of a face, one for either side, cancel each other. Duplicates are dropped if that leaves fewer open edges, or if the
 * mesh has no volume with them. */
static status drop_duplicates(struct repair *w)
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
    TRY(mesh_drop_duplicates(w->mesh, &dropped));
    if (dropped == 0)
        goto done;
    TRY(find_open(w));
    if (flat || w->open->n < n_open) {
        log_info("%s: %zu of %zu triangles were duplicates: dropped", w->path, dropped, n_triangles);
        goto done;
    }
    memcpy(w->mesh->triangle, before, n_triangles * sizeof *before);
    w->mesh->n_triangles = n_triangles;
    TRY(find_open(w));
done:
    free(before);
    return st;
}

status mesh_repair(struct mesh *mesh, const char *path, double tolerance, struct mesh_open *open)
{
    status st = OK;
    size_t flipped = 0;
    struct mesh_welded welded = {0};
    struct repair repair = {path, mesh, open}, *w = &repair;
    *open = (struct mesh_open){0};
    TRY(mesh_weld(mesh));
    TRY(find_open(w));
    if (open->n > 0)
        TRY(mesh_weld_open(mesh, open, tolerance, &welded));
    if (welded.n > 0) {
        log_info(
            "%s: the surface was open along %zu edges: %zu of their vertices are joined to others, at most %.2g m away (the tolerance is %.2g m)",
            path, open->n, welded.n, welded.farthest, tolerance);
        TRY(find_open(w));
    }
    TRY(drop_duplicates(w));
    if (mesh->n_triangles == 0) {
        st = fail(E_INPUT, "%s: all faces are degenerate (points or lines)", path);
        goto done;
    }
    TRY(mesh_orient_outwards(mesh, open, &flipped));
    if (open->n == 0 && is_flat(mesh)) {
        st = fail(
            E_INPUT,
            "%s: its faces cancel each other and enclose no volume, for each occurs once for either side: remove the duplicates (in Blender: Mesh > Clean Up > Merge by Distance, or export without both sides)",
            path);
        goto done;
    }
    if (flipped > 0)
        log_info("%s: %zu of its parts were inside out: flipped", path, flipped);
done:
    return st;
}
