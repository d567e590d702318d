#include "scene/mesh_sdf.h"

#include <stdatomic.h>

#include "base/library.h"
#include "scene/mesh_sdf_make.h"

/* Set before there is any distance field. */
static _Atomic(sdf_at_function *) at;
static _Atomic(sdf_destroy_function *) destroy;

status vdb_sdf_from_mesh(const double (*vertex)[3], size_t n_vertices, const uint32_t (*triangle)[3],
                         size_t n_triangles, double voxel, double band, struct vdb_sdf **out)
{
    status st = OK;
    sdf_make_function *make = NULL;
    sdf_at_function *found_at = NULL;
    sdf_destroy_function *found_destroy = NULL;
    TRY(library_find("sdf_make", &make));
    TRY(library_find("sdf_at", &found_at));
    TRY(library_find("sdf_destroy", &found_destroy));
    atomic_store(&at, found_at);
    atomic_store(&destroy, found_destroy);
    TRY(library_said(make(vertex, n_vertices, triangle, n_triangles, voxel, band, out)));
done:
    return st;
}

void vdb_sdf_destroy(struct vdb_sdf **sdf)
{
    sdf_destroy_function *call = atomic_load(&destroy);
    if (*sdf && call)
        call(sdf);
}

double vdb_sdf_at(const struct vdb_sdf *sdf, const double x[3])
{
    return atomic_load_explicit(&at, memory_order_relaxed)(sdf, x);
}
