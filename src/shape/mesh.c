#include "shape/mesh.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/log.h"
#include "meshinput/ask.h"
#include "meshinput/edges.h"
#include "meshinput/repair.h"
#include "meshinput/winding.h"

/* Limit of a mesh's grid values: about 1 GiB, including the memory to build it. */
#define MAX_GRID_VALUES 64e6

/* Limit of the share of an open mesh's area that encloses nothing (sheets). */
#define MAX_SHEETS 0.05

/* A mesh that is being made into a solid. */
struct work {
    const char *path;
    struct mesh mesh;
    double min[3], max[3]; /* m */
    double voxel, band;    /* m */
    double file_m3;
    struct mesh_open open;
    struct winding *winding;
};

static status place_vertices(struct mesh *mesh, const char *path, bool y_up, bool auto_origin,
                             const struct placement *place, double min[3], double max[3])
{
    double origin[3] = {0, 0, 0};
    for (size_t i = 0; i < mesh->n_vertices && y_up; i++) {
        double *v = mesh->vertex[i], y = v[1];
        v[1] = -v[2];
        v[2] = y;
    }
    for (int a = 0; a < 3 && auto_origin; a++) {
        origin[a] = INFINITY;
        for (size_t i = 0; i < mesh->n_vertices; i++)
            origin[a] = fmin(origin[a], mesh->vertex[i][a]);
    }
    if (auto_origin)
        log_info("%s: origin auto: moved by minus its lowest corner, (%.10g, %.10g, %.10g) m with z up", path,
                 origin[0], origin[1], origin[2]);
    for (size_t i = 0; i < mesh->n_vertices; i++) {
        double *v = mesh->vertex[i];
        const double local[3] = {v[0] - origin[0], v[1] - origin[1], v[2] - origin[2]};
        placement_apply(place->world_from_local, local, v);
        for (int a = 0; a < 3; a++) {
            if (!(fabs(v[a]) <= 1e6))
                return fail(
                    E_INPUT,
                    "%s: vertex %zu is at (%.10g, %.10g, %.10g) m, farther out than 1e6 m: scale the mesh down, or set origin: auto if it has map coordinates",
                    path, i + 1, v[0], v[1], v[2]);
            min[a] = fmin(min[a], v[a]);
            max[a] = fmax(max[a], v[a]);
        }
    }
    return OK;
}

status mesh_read_placed(const struct mesh_source *source, struct mesh *mesh, double min[3], double max[3])
{
    status st = OK;
    TRY(mesh_read(source->file, source->attribute, mesh));
    if (mesh->y_up && !source->y_up)
        log_warn(
            "%s: glTF files are y up, but %s.up is z: set %s.up: y unless the mesh lies on its side in the file",
            source->file, source->key, source->key);
    TRY(place_vertices(mesh, source->file, source->y_up, source->auto_origin, source->place, min, max));
done:
    return st;
}

static double longest_side(const struct work *w)
{
    double longest = 0;
    for (int k = 0; k < 3; k++)
        longest = fmax(longest, w->max[k] - w->min[k]);
    return longest;
}

/* The grid's spacing: `detail`, or coarser if the mesh is so large that its grid would exceed MAX_GRID_VALUES. */
static double choose_voxel(const struct work *w, double detail, double reach)
{
    double area = 0;
    for (size_t i = 0; i < w->mesh.n_triangles; i++)
        area += mesh_triangle_area(&w->mesh, i);
    double fits = fmax(cbrt(2 * area * reach / MAX_GRID_VALUES), longest_side(w) / 1e6);
    if (fits > detail)
        log_warn(
            "%s: the mesh is voxelised at %.3g m instead of %.3g m to fit in memory: cut off what is outside of the domain",
            w->path, fits, detail);
    return fmax(fits, detail);
}

/* ---- holes */

#define HOW_TO_FILL                                                                                          \
    "fill the holes (in Blender: Select > All by Trait > Non Manifold, then Face > Fill) and export again"

static const double *open_at(const struct work *w)
{
    return w->mesh.vertex[w->open.edge[0][0]];
}

/* The share of an open mesh's area that has no inside on either side, estimated from some thousands of its triangles. */
static double share_of_sheets(const struct work *w)
{
    const size_t step = w->mesh.n_triangles / 4096 + 1;
    double area = 0, sheets = 0;
    for (size_t t = 0; t < w->mesh.n_triangles; t += step) {
        const double own = mesh_triangle_area(&w->mesh, t);
        const uint32_t *corner = w->mesh.triangle[t];
        bool inside = false;
        double n[3], x[3];
        mesh_triangle_normal(&w->mesh, t, n);
        for (int side = -1; side <= 1 && own > 0; side += 2) {
            for (int a = 0; a < 3; a++)
                x[a] = side * 0.01 * w->voxel * n[a] / own +
                       (w->mesh.vertex[corner[0]][a] + w->mesh.vertex[corner[1]][a] +
                        w->mesh.vertex[corner[2]][a]) /
                           3;
            inside |= fabsf(winding_number(w->winding, x)) >= 0.5F;
        }
        area += own;
        sheets += inside ? 0 : own;
    }
    return area > 0 ? sheets / area : 1;
}

static status check_sheets(const struct work *w)
{
    const double share = share_of_sheets(w), *at = open_at(w);
    if (share > MAX_SHEETS)
        return fail(
            E_INPUT,
            "%s: the surface is open: it has %zu boundary edges, one at (%.6g, %.6g, %.6g) m in the scene, and %.0f %% of its area are sheets that enclose nothing: " HOW_TO_FILL,
            w->path, w->open.n, at[0], at[1], at[2], 100 * share);
    return OK;
}

static void compute_winding(const void *winding, const double (*x)[3], size_t n, float *number)
{
    winding_numbers(winding, x, n, number);
}

static status sample(const struct work *w, double voxel, double band, double hole, struct vdb_sdf **out)
{
    const struct sdf_request q = {
        .vertex = (const double(*)[3])w->mesh.vertex,
        .n_vertices = w->mesh.n_vertices,
        .triangle = (const uint32_t(*)[3])w->mesh.triangle,
        .n_triangles = w->mesh.n_triangles,
        .voxel = voxel,
        .band = band,
        .winding = compute_winding,
        .context = w->winding,
        .open = (const uint32_t(*)[2])w->open.edge,
        .n_open = w->open.n,
        .hole = hole,
    };
    return vdb_sdf_create(&q, out);
}

/* Measures a gap that is wider than the band, with larger and larger voxels. */
static status measure_gap(const struct work *w, struct sdf_gap *gap)
{
    status st = OK;
    const double longest = longest_side(w);
    for (double voxel = w->voxel, band = w->band; gap->width > 1.9 * band && band < 2 * longest;) {
        struct vdb_sdf *coarse = NULL;
        voxel *= 4;
        band = 8 * voxel;
        TRY(sample(w, voxel, band, INFINITY, &coarse));
        const struct sdf_gap found = vdb_sdf_gap(coarse);
        vdb_sdf_destroy(&coarse);
        if (found.width == 0)
            break;
        *gap = found;
    }
done:
    return st;
}

static status refuse_gap(const struct work *w, struct sdf_gap gap)
{
    return fail(
        E_INPUT,
        "%s: the surface is open: it has %zu boundary edges, one at (%.6g, %.6g, %.6g) m in the scene, and the widest gap is about %.2g m, near (%.4g, %.4g, %.4g): " HOW_TO_FILL
        ", or close gaps up to a width by flat caps with mesh.fill_holes_m",
        w->path, w->open.n, open_at(w)[0], open_at(w)[1], open_at(w)[2], gap.width, gap.at[0], gap.at[1],
        gap.at[2]);
}

/* Adds the triangles that close the gaps to the mesh. Its winding number remains that of the open mesh. */
static status close_gaps(struct work *w, struct vdb_sdf **sdf)
{
    status st = OK;
    struct sdf_caps caps;
    struct mesh *m = &w->mesh;
    const size_t n = m->n_vertices;
    TRY(vdb_sdf_caps(*sdf, &caps));
    vdb_sdf_destroy(sdf);
    for (size_t i = 0; i < caps.n_vertices; i++)
        TRY(mesh_add_vertex(m, caps.vertex[i]));
    for (size_t t = 0; t < caps.n_triangles; t++) {
        const uint32_t *c = caps.triangle[t], first = (uint32_t)n;
        TRY(mesh_add_triangle(m, first + c[0], first + c[1], first + c[2]));
    }
done:
    free(caps.vertex);
    free(caps.triangle);
    return st;
}

static status sample_open(struct work *w, double fill, struct vdb_sdf **out)
{
    status st = OK;
    const double widest = fmax(fill, 2 * w->voxel), voxel = w->voxel, band = w->band;
    TRY(check_sheets(w));
    TRY(sample(w, voxel, band, fmax(4 * voxel, fmin(widest, band)), out));
    struct sdf_gap gap = vdb_sdf_gap(*out);
    if (gap.width == 0) {
        log_warn(
            "%s: the surface is open along %zu edges, one at (%.6g, %.6g, %.6g) m in the scene, but no gap is as wide as %.2g m: it counts as closed",
            w->path, w->open.n, open_at(w)[0], open_at(w)[1], open_at(w)[2], 2 * voxel);
        return OK;
    }
    TRY(measure_gap(w, &gap));
    if (gap.width > widest + voxel) {
        vdb_sdf_destroy(out);
        TRY(refuse_gap(w, gap));
    }
    if (gap.width > band) { /* the band does not reach to the other side of such a gap */
        vdb_sdf_destroy(out);
        w->band = gap.width / 2 + 4 * voxel;
        w->voxel = choose_voxel(w, voxel, w->band);
        TRY(sample(w, w->voxel, w->band, gap.width, out));
    }
    log_warn(
        "%s: the surface is open along %zu edges, with gaps of up to %.2g m, which are closed (the limit, mesh.fill_holes_m, is %.2g m)",
        w->path, w->open.n, gap.width, widest);
    w->voxel = voxel;
    w->band = band;
    TRY(close_gaps(w, out));
    TRY(sample(w, voxel, band, fmax(4 * voxel, gap.width), out));
done:
    return st;
}

/* Makes the distance field of w->mesh, which is changed. */
static status make_sdf(struct work *w, double fill, double detail, double reach, struct vdb_sdf **out,
                       double min[3], double max[3])
{
    status st = OK;
    memcpy(min, w->min, sizeof w->min);
    memcpy(max, w->max, sizeof w->max);
    w->voxel = choose_voxel(w, detail, reach);
    w->band = fmax(reach, 3 * w->voxel);
    /* The rounding of single precision or a thousandth of a voxel, but not so much that faces would collapse. */
    const double tolerance = fmin(fmax(longest_side(w) * 0x1p-20, w->voxel / 1000), w->voxel / 8);
    TRY(mesh_repair(&w->mesh, w->path, tolerance, &w->open));
    w->file_m3 = w->open.n ? (double)NAN : fabs(mesh_volume(&w->mesh));
    TRY(winding_create((const double(*)[3])w->mesh.vertex, w->mesh.n_vertices,
                       (const uint32_t(*)[3])w->mesh.triangle, w->mesh.n_triangles, w->open.n ? 2 : 1.5,
                       &w->winding));
    if (w->open.n > 0)
        TRY(sample_open(w, fill, out));
    else
        TRY(sample(w, w->voxel, w->band, 0, out));
done:
    winding_destroy(&w->winding);
    free(w->open.edge);
    return st;
}

static const struct work empty_work = {.min = {INFINITY, INFINITY, INFINITY},
                                       .max = {-INFINITY, -INFINITY, -INFINITY}};

status mesh_shape_create(const struct job_mesh *job, const struct placement *place, double detail,
                         double reach, struct vdb_sdf **out, double min[3], double max[3], double *file_m3)
{
    status st = OK;
    struct work w = empty_work;
    w.path = job->file;
    TRY(mesh_read_placed(&(struct mesh_source){.file = job->file,
                                               .key = "mesh",
                                               .y_up = job->up == MESH_UP_Y,
                                               .auto_origin = job->origin == MESH_ORIGIN_AUTO,
                                               .place = place},
                         &w.mesh, w.min, w.max));
    TRY(make_sdf(&w, job->fill_holes_m, detail, reach, out, min, max));
    *file_m3 = w.file_m3;
done:
    mesh_free(&w.mesh);
    return st;
}

/* A solid recovered from a frame's volumes. */
static status make_solid(const char *path, const struct mesh_solid *solid, const struct placement *place,
                         struct vdb_sdf **out, double min[3], double max[3], double *file_m3)
{
    status st = OK;
    const struct solid_part *p = &solid->part;
    struct sdf_samples samples = {.n = (size_t)p->n,
                                  .at = (const int32_t(*)[3])solid->at,
                                  .value = solid->value,
                                  .voxel = p->voxel * place->min_scale};
    double low[3] = {INFINITY, INFINITY, INFINITY}, high[3] = {-INFINITY, -INFINITY, -INFINITY};
    for (int r = 0; r < 3; r++) {
        samples.world_from_index[r][3] = place->world_from_local[r][3];
        for (int c = 0; c < 3; c++) {
            samples.world_from_index[r][c] = place->world_from_local[r][c] * p->voxel;
            samples.world_from_index[r][3] += place->world_from_local[r][c] * p->origin[c];
        }
    }
    for (size_t i = 0; i < p->n; i++)
        for (int a = 0; a < 3 && solid->value[i] < 0; a++) {
            low[a] = fmin(low[a], p->origin[a] + (solid->at[i][a] - 1) * p->voxel);
            high[a] = fmax(high[a], p->origin[a] + (solid->at[i][a] + 1) * p->voxel);
        }
    if (!(low[0] < high[0]))
        return fail(E_INPUT, "%s: the frame has no rock", path);
    placement_box(place, low, high, min, max);
    *file_m3 = p->filled * p->voxel * p->voxel * p->voxel * placement_volume_scale(place);
    TRY(vdb_sdf_from_samples(&samples, out));
done:
    return st;
}

status volume_shape_create(const struct job_volume *job, const struct placement *place, double detail,
                           double reach, struct vdb_sdf **out, double min[3], double max[3], double *file_m3)
{
    status st = OK;
    struct work w = empty_work;
    struct mesh_part part;
    struct mesh_solid solid;
    char density[32];
    w.path = job->file;
    snprintf(density, sizeof density, "%.9g", job->density);
    TRY(mesh_read_volume(job->file, (const char *const[]){job->grid, density, NULL}, &part, &w.mesh, &solid));
    if (part.is_solid) {
        log_note("%s: the solid of a frame, as its grids 'density' and 'surface' describe it", job->file);
        TRY(make_solid(job->file, &solid, place, out, min, max, file_m3));
        goto done;
    }
    const bool y_up = job->up == VOLUME_UP_Y || (job->up == VOLUME_UP_FILE && part.y_up);
    log_note("%s: grid '%s' is read as %s%s, %c up", job->file, part.grid,
             part.is_fog ? "a fog volume, solid above a density of " : "a level set",
             part.is_fog ? density : "", y_up ? 'y' : 'z');
    if (part.n_choices > 1)
        log_warn("%s: it has %u grids %s, and the first is used%s%s%s", job->file, part.n_choices,
                 *job->grid ? "of that name" : "of floats", *job->grid ? "" : ", '",
                 *job->grid ? "" : part.grid, *job->grid ? "" : "': choose one with volume.grid");
    if (w.mesh.n_triangles == 0) {
        st = fail(E_INPUT, "%s: grid '%s' has no surface%s%s", job->file, part.grid,
                  part.is_fog ? " at a density of " : "", part.is_fog ? density : "");
        goto done;
    }
    TRY(place_vertices(&w.mesh, job->file, y_up, false, place, w.min, w.max));
    TRY(make_sdf(&w, 0, detail, reach, out, min, max));
    *file_m3 = w.file_m3;
done:
    mesh_solid_free(&solid);
    mesh_free(&w.mesh);
    return st;
}
