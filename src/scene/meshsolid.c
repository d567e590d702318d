#include "scene/meshsolid.h"

#include <math.h>
#include <string.h>

#include "base/log.h"
#include "scene/meshfile.h"

/* Grid values a mesh may take, about 1 GiB with what building it needs on top. */
#define MAX_GRID_VALUES 64e6

static status place_vertices(struct mesh *mesh, const struct job_mesh *job, const struct placement *place,
                             double min[3], double max[3])
{
    for (size_t i = 0; i < mesh->n_vertices; i++) {
        double *v = mesh->vertex[i];
        double local[3] = {v[0], job->up == MESH_UP_Y ? -v[2] : v[1], job->up == MESH_UP_Y ? v[1] : v[2]};
        placement_apply(place->world_from_local, local, v);
        for (int a = 0; a < 3; a++) {
            if (!(fabs(v[a]) <= 1e6))
                return fail(
                    E_INPUT,
                    "%s: vertex %zu stands at (%g, %g, %g) m, farther than 1e6 m: scale the mesh down",
                    job->file, i + 1, v[0], v[1], v[2]);
            min[a] = fmin(min[a], v[a]);
            max[a] = fmax(max[a], v[a]);
        }
    }
    return OK;
}

/* The grid's spacing: what is asked for, or coarser where the mesh is so large that its grid would not fit.
 */
static double choose_voxel(const struct mesh *mesh, const char *path, double detail, double reach,
                           const double min[3], const double max[3])
{
    double area = 0, longest = 0;
    for (size_t i = 0; i < mesh->n_triangles; i++) {
        const double *a = mesh->vertex[mesh->triangle[i][0]], *b = mesh->vertex[mesh->triangle[i][1]],
                     *c = mesh->vertex[mesh->triangle[i][2]];
        double u[3], v[3];
        for (int k = 0; k < 3; k++) {
            u[k] = b[k] - a[k];
            v[k] = c[k] - a[k];
        }
        double x = u[1] * v[2] - u[2] * v[1], y = u[2] * v[0] - u[0] * v[2], z = u[0] * v[1] - u[1] * v[0];
        area += 0.5 * sqrt(x * x + y * y + z * z);
    }
    for (int k = 0; k < 3; k++)
        longest = fmax(longest, max[k] - min[k]);
    double fits = fmax(cbrt(2 * area * reach / MAX_GRID_VALUES), longest / 1e6);
    if (fits > detail)
        log_warn("%s: the mesh is sampled every %.3g m instead of %.3g m, to fit in memory: cut off what "
                 "lies outside the "
                 "domain",
                 path, fits, detail);
    return fmax(fits, detail);
}

static status check_closed(const struct mesh *mesh, const char *path, double voxel)
{
    status st = OK;
    struct mesh_holes holes;
    TRY(mesh_find_holes(mesh, &holes));
    if (holes.n_edges == 0)
        return OK;
    if (holes.width > voxel)
        return fail(E_INPUT,
                    "%s: the surface is open: %zu edges belong to one triangle only, one at (%.6g, %.6g, "
                    "%.6g) m in the "
                    "scene, the widest hole is %.3g m: fill the holes (in Blender: Select > All by Trait > "
                    "Non Manifold, "
                    "then Face > Fill) and export again",
                    path, holes.n_edges, holes.first[0], holes.first[1], holes.first[2], holes.width);
    log_warn("%s: the surface is open along %zu edges, in holes of up to %.3g m: closed, as they are smaller "
             "than the "
             "sampling (%.3g m)",
             path, holes.n_edges, holes.width, voxel);
done:
    return st;
}

status mesh_solid(const struct job_mesh *job, const struct placement *place, double detail, double reach,
                  struct vdb_sdf **out, double min[3], double max[3])
{
    status st = OK;
    struct mesh mesh;
    TRY(mesh_read(job->file, &mesh));
    TRY(place_vertices(&mesh, job, place, min, max));
    TRY(mesh_weld(&mesh));
    if (mesh.n_triangles == 0) {
        st = fail(E_INPUT, "%s: every face is a point or a line", job->file);
        goto done;
    }
    double voxel = choose_voxel(&mesh, job->file, detail, reach, min, max);
    TRY(check_closed(&mesh, job->file, voxel));
    double band = fmax(reach, 3 * voxel);
    TRY(vdb_sdf_from_mesh((const double(*)[3])mesh.vertex, mesh.n_vertices,
                          (const uint32_t(*)[3])mesh.triangle, mesh.n_triangles, voxel, band, out));
done:
    mesh_free(&mesh);
    return st;
}
