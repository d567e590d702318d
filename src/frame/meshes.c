#include "frame/meshes.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/memory.h"
#include "base/version.h"
#include "frame/rocks.h"
#include "geology/attitude.h"
#include "job/palette.h"
#include "mesh/trimesh.h"
#include "output/mesh_file.h"
#include "output/product.h"
#include "particles/layers.h"
#include "stacks/material.h"
#include "vdb/vdb.h"

/* The values that vertices have. Values whose grid the job does not have, such as those of water or plants, are 0. Where rock moves,
 * the three components of its velocity follow the n values. */
enum { VELOCITY = 3 };
struct carried {
    enum value_id id[VALUES];
    const char *name[VALUES];
    size_t n, n_velocity, n_optional; /* the grids of the last n_optional may be missing */
};

static struct carried carried_by(const struct job *job)
{
    struct carried c = {0};
    for (int optional = 0; optional < 2; optional++)
        for (int v = 1; v < VALUES; v++) {
            const struct value *a = &value_table[v];
            if (!(a->where & IN_MESHES) || (a->has != HAS_ALWAYS) != optional ||
                (a->has == HAS_TERRAIN && !job_model(job)->terrain) || !job_may_have(job, a->has))
                continue;
            c.id[c.n] = (enum value_id)v;
            c.name[c.n++] = a->name;
            c.n_optional += (size_t)optional;
        }
    static const char *const velocity[VELOCITY] = {"vel.x", "vel.y", "vel.z"};
    c.n_velocity = job->clock.seconds_per_frame > 0 ? VELOCITY : 0;
    c.n_optional += c.n_velocity;
    memcpy(c.name + c.n, velocity, c.n_velocity * sizeof *velocity);
    return c;
}

/* ---- layers and colours */

static size_t layer_at(const struct job *job, const float x[3])
{
    return attitude_layer(job, (const double[]){(double)x[0], (double)x[1], (double)x[2]});
}

struct labels {
    const struct job *job;
    const struct layers *layers; /* NULL: layers follow from the position */
};

static status set_labels(void *user, const float (*vertex)[3], size_t n, uint32_t *label)
{
    const struct labels *l = user;
    const size_t most = palette_size(l->job);
#pragma omp parallel for
    for (size_t i = 0; i < n; i++)
        if (!l->layers || !layers_at(l->layers, vertex[i], &label[i]) || label[i] >= most)
            label[i] = (uint32_t)layer_at(l->job, vertex[i]);
    return OK;
}

/* The colour of the vertex's layer. On terrain, the colours of the materials are mixed by their shares; the remainder has the colour of
 * the layer. */
static void color_of(const struct job *job, const struct carried *carried, const struct vdb_mesh *m, size_t i,
                     float rgb[3])
{
    double rest = 1, sum[3] = {0};
    palette_color(job, m->label[i], rgb);
    if (!job_model(job)->terrain)
        return;
    const size_t bedrock = layer_at(job, m->vertex + 3 * i);
    for (size_t k = 0; k < carried->n; k++) {
        const int material = value_material[carried->id[k]];
        float own[3];
        if (material == MATERIAL_AIR)
            continue;
        double share = (double)m->value[k * m->n_vertices + i];
        palette_color(
            job, material == MATERIAL_BEDROCK ? bedrock : job->n_strata + (size_t)(material - MATERIAL_SAND),
            own);
        for (int c = 0; c < 3; c++)
            sum[c] += share * (double)own[c];
        rest -= share;
    }
    for (int c = 0; c < 3; c++)
        rgb[c] = (float)(sum[c] + (rest > 0 ? rest : 0) * (double)rgb[c]);
}

/* ---- files */

/* The part of the files' names that follows the job's name. */
static const char *part(bool rocks)
{
    return rocks ? "rocks" : NULL;
}

static status put(const struct recipe *recipe, const struct meshes *m, enum folder_file kind, bool rocks,
                  const void *bytes, size_t n)
{
    struct path path;
    const status st = folder_name(&path, m->job->name, kind, recipe->frame, part(rocks));
    return st == OK ? product_write(recipe, path.text, bytes, n) : st;
}

/* Rocks get no USD mesh, since rocks/NAME.FRAME.usdc has them as instances. */
static status write_files(const struct meshes *m, bool rocks, int frame, struct mesh_file *file)
{
    status st = OK;
    char comment[400];
    struct text text = {0};
    struct draft usd = {0};
    struct recipe recipe = m->recipe;
    TRY(recipe_of_frame(&recipe, m->job->name, frame));
    snprintf(comment, sizeof comment, "hoodoo %s: %.255s, frame %d; metres, %s up", hoodoo_version,
             m->job->name, frame, m->job->output.up == OUTPUT_UP_Y ? "y" : "z");
    file->name = m->job->name;
    file->comment = comment;
    file->up = m->job->output.up;
    mesh_file_ply(file, &text);
    TRY(text_status(&text));
    TRY(put(&recipe, m, FILE_MESH, rocks, text.data, text.size));
    text_free(&text);
    mesh_file_obj(file, &text);
    TRY(text_status(&text));
    TRY(put(&recipe, m, FILE_OBJ, rocks, text.data, text.size));
    if (rocks)
        goto done;
    TRY(usd_mesh(file, frame, m->job->fps, &usd));
    TRY(put(&recipe, m, FILE_MESH_USD, rocks, usd.bytes, usd.size));
done:
    text_free(&text);
    draft_drop(&usd);
    return st;
}

void meshes_prim(const struct job *job, struct usd_prim *out)
{
    const struct carried c = carried_by(job);
    usd_mesh_prim(c.name, c.n, c.n_velocity > 0, out);
}

static status write_surface(const struct meshes *m, int frame)
{
    status st = OK;
    struct path path;
    struct rock rock = {0};
    struct layers layers = {0};
    struct labels labels = {.job = m->job};
    struct vdb_mesh mesh = {0};
    float(*color)[3] = NULL;
    const struct carried carried = carried_by(m->job);
    TRY(folder_path(&path, m->recipe.root, m->job->name, FILE_POINTS, frame, NULL));
    if (access(path.text, R_OK) == 0) {
        TRY(vdb_points_read(path.text, &rock));
        if (rock.layer) {
            TRY(layers_create(&rock, m->job->domain.spacing_m, &layers));
            labels.layers = &layers;
        }
    }
    const struct vdb_mesh_options options = {.adaptivity = m->adaptivity,
                                             .smooth = m->smooth,
                                             .values = carried.name,
                                             .n_values = carried.n + carried.n_velocity,
                                             .n_optional = carried.n_optional,
                                             .label = set_labels,
                                             .user = &labels};
    TRY(folder_path(&path, m->recipe.root, m->job->name, FILE_VOLUMES, frame, NULL));
    TRY(vdb_mesh_make(path.text, &options, &mesh));
    TRY(memory_alloc(mesh.n_vertices, sizeof *color, "colours", &color));
#pragma omp parallel for
    for (size_t i = 0; i < mesh.n_vertices; i++)
        color_of(m->job, &carried, &mesh, i, color[i]);
    TRY(write_files(
        m, false, frame,
        &(struct mesh_file){.n_vertices = mesh.n_vertices,
                            .n_triangles = mesh.n_triangles,
                            .vertex = mesh.vertex,
                            .normal = mesh.normal,
                            .triangle = mesh.triangle,
                            .n_values = carried.n,
                            .value_name = carried.name,
                            .value = mesh.value,
                            .velocity = carried.n_velocity ? mesh.value + carried.n * mesh.n_vertices : NULL,
                            .layer = mesh.label,
                            .color = (const float(*)[3])color}));
done:
    free(color);
    vdb_mesh_free(&mesh);
    layers_destroy(&layers);
    rock_free(&rock);
    return st;
}

/* ---- rocks */

/* A rock of the tile, simplified like the surface and by at least 2 % of its radius, because there may be thousands of rocks. */
static status rock_shape(const struct meshes *m, const struct pile_tile *tile, size_t which,
                         struct trimesh *out)
{
    status st = OK;
    const struct pile_rock *r = &tile->rock[which];
    uint32_t *kept = NULL;
    double tolerance = fmax(m->adaptivity * m->job->domain.spacing_m, 0.02 * tile->radius);
    *out = (struct trimesh){.n_vertices = r->n_vertices, .n_triangles = tile->n_triangles};
    TRY(memory_alloc(out->n_vertices, 3 * sizeof *out->vertex, "a rock", &out->vertex));
    TRY(memory_alloc(out->n_triangles, 3 * sizeof *out->triangle, "a rock", &out->triangle));
    memcpy(out->vertex, r->vertex, out->n_vertices * 3 * sizeof *out->vertex);
    memcpy(out->triangle, tile->triangle, out->n_triangles * 3 * sizeof *out->triangle);
    TRY(trimesh_simplify(out, NULL, tolerance, 4 * tile->radius, &kept));
done:
    free(kept);
    return st;
}

/* Joins all rocks into one mesh. */
static status join_rocks(const struct rock *at, const struct trimesh *shape, size_t n_shapes,
                         struct trimesh *out)
{
    status st = OK;
    struct trimesh all = {0};
    for (size_t i = 0; i < at->n; i++) {
        if (at->layer[i] >= n_shapes) {
            st = fail(E_INPUT,
                      "a rock has shape %u, but the job has %zu shapes: the file belongs to another job",
                      at->layer[i], n_shapes);
            goto done;
        }
        all.n_vertices += shape[at->layer[i]].n_vertices;
        all.n_triangles += shape[at->layer[i]].n_triangles;
    }
    if (all.n_vertices > INT32_MAX) {
        st = fail(E_OUTPUT,
                  "the rocks have %zu vertices, too many for one mesh; use --adaptivity or --no-rocks",
                  all.n_vertices);
        goto done;
    }
    TRY(memory_alloc(all.n_vertices, 3 * sizeof *all.vertex, "rocks", &all.vertex));
    TRY(memory_alloc(all.n_triangles, 3 * sizeof *all.triangle, "rocks", &all.triangle));
    float *vertex = all.vertex;
    uint32_t *triangle = all.triangle, first = 0;
    for (size_t i = 0; i < at->n; i++) {
        const struct trimesh *s = &shape[at->layer[i]];
        for (size_t v = 0; v < 3 * s->n_vertices; v++)
            *vertex++ = at->P[4 * i + v % 3] + s->vertex[v];
        for (size_t c = 0; c < 3 * s->n_triangles; c++)
            *triangle++ = first + s->triangle[c];
        first += (uint32_t)s->n_vertices;
    }
    *out = all;
    all = (struct trimesh){0};
done:
    trimesh_free(&all);
    return st;
}

static status write_rocks(const struct meshes *m, int frame)
{
    status st = OK;
    struct path path;
    struct pile_tile tile = {0};
    struct rock at = {0};
    struct trimesh *shape = NULL, all = {0};
    float *normal = NULL, (*color)[3] = NULL;
    uint32_t *layer = NULL;
    TRY(folder_path(&path, m->recipe.root, m->job->name, FILE_ROCKS, frame, NULL));
    TRY(vdb_points_read(path.text, &at));
    TRY(rocks_tile(m->job, &tile));
    TRY(memory_alloc(tile.n, sizeof *shape, "rocks", &shape));
    for (size_t i = 0; i < tile.n; i++)
        TRY(rock_shape(m, &tile, i, &shape[i]));
    TRY(join_rocks(&at, shape, tile.n, &all));
    TRY(memory_alloc(all.n_vertices, 3 * sizeof *normal, "rocks", &normal));
    TRY(memory_alloc(all.n_vertices, sizeof *color, "rocks", &color));
    TRY(memory_alloc(all.n_vertices, sizeof *layer, "rocks", &layer));
    trimesh_normals(&all, normal);
    for (size_t i = 0; i < all.n_vertices; i++) {
        layer[i] = rocks_layer(m->job);
        palette_color(m->job, layer[i], color[i]);
    }
    TRY(write_files(m, true, frame,
                    &(struct mesh_file){.n_vertices = all.n_vertices,
                                        .n_triangles = all.n_triangles,
                                        .vertex = all.vertex,
                                        .normal = normal,
                                        .triangle = all.triangle,
                                        .layer = layer,
                                        .color = (const float(*)[3])color}));
done:
    for (size_t i = 0; shape && i < tile.n; i++)
        trimesh_free(&shape[i]);
    free(shape);
    trimesh_free(&all);
    free(normal);
    free(color);
    free(layer);
    rock_free(&at);
    pile_tile_destroy(&tile);
    return st;
}

static bool has_rocks(const struct meshes *m)
{
    return m->rocks && job_piles(m->job);
}

status meshes_write(const struct meshes *m, int frame)
{
    status st = OK;
    TRY(write_surface(m, frame));
    if (has_rocks(m))
        TRY(write_rocks(m, frame));
done:
    return st;
}

status meshes_done(const struct meshes *m, int frame, bool *done)
{
    static const enum folder_file kind[] = {FILE_MESH, FILE_OBJ, FILE_MESH_USD};
    status st = OK;
    struct path path;
    struct recipe recipe = m->recipe;
    *done = true;
    TRY(recipe_of_frame(&recipe, m->job->name, frame));
    for (int rocks = 0; rocks <= has_rocks(m); rocks++)
        for (int e = 0; e < (rocks ? 2 : 3) && *done; e++) {
            TRY(folder_name(&path, m->job->name, kind[e], frame, part(rocks)));
            TRY(product_done(&recipe, path.text, true, done));
        }
done:
    return st;
}
