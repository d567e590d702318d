/* Makes a mesh of the zero surface of a frame's level set, with values of the frame's other grids at its vertices. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "mesh/trimesh.h"
#include "reader/reader.h"
#include "vdb/vdb.h"

/* Voxels: the longest edge after simplification, because values vary along edges. */
static const double LONGEST = 12;

/* Adds the file to the message of an error. */
static status in_file(const char *path, status st)
{
    char said[1000];
    if (st == OK)
        return OK;
    snprintf(said, sizeof said, "%s", status_message());
    return fail(st, "%s: %s", path, said);
}

/* Gets the samples from the reader and makes the surface. */
static status march(const char *path, struct trimesh *out, double *voxel)
{
    status st = OK;
    struct reader_answer answer = {0};
    struct trimesh_lattice lattice;
    float *sample = NULL;
    size_t n = 1;
    TRY(reader_ask(&(struct reader_question){.program = "hoodoo-read", .kind = "vdb.surface", .path = path},
                   &answer));
    TRY(reader_take(&answer, &lattice, sizeof lattice));
    bool good = isfinite(lattice.voxel) && lattice.voxel > 0;
    for (int a = 0; good && a < 3; a++) {
        good = lattice.n[a] > 0 && n <= SIZE_MAX / (size_t)lattice.n[a];
        n *= good ? (size_t)lattice.n[a] : 1;
    }
    if (!good) {
        st = reader_bad_answer(&answer);
        goto done;
    }
    TRY(reader_take_array(&answer, n, sizeof *sample, &sample));
    *voxel = lattice.voxel;
    TRY(in_file(path, trimesh_march(sample, &lattice, out)));
done:
    free(sample);
    reader_end(&answer);
    return st;
}

/* Labels, smooths, simplifies. */
static status work_on(struct trimesh *m, const struct vdb_mesh_options *o, double voxel, uint32_t **label)
{
    status st = OK;
    uint32_t *kept = NULL;
    if (o->label) {
        TRY(memory_alloc(m->n_vertices, sizeof **label, "labels", label));
        TRY(o->label(o->user, (const float(*)[3])(void *)m->vertex, m->n_vertices, *label));
    }
    if (o->smooth > 0)
        TRY(trimesh_smooth(m, *label, o->smooth, VDB_MESH_SMOOTH_REACH * voxel));
    if (o->adaptivity > 0)
        TRY(trimesh_simplify(m, *label, o->adaptivity * voxel, LONGEST * voxel, &kept));
    for (size_t i = 0; kept && *label && i < m->n_vertices; i++)
        (*label)[i] = (*label)[kept[i]];
done:
    free(kept);
    return st;
}

/* Gets the values of the file's grids at the vertices. */
static status read_values(const char *path, const struct trimesh *m, const struct vdb_mesh_options *o,
                          struct vdb_mesh *out)
{
    status st = OK;
    struct reader_answer answer = {0};
    char optional[24];
    const char *word[VALUES + 3] = {o->smooth > 0 ? "0" : "1", optional};
    if (o->n_values > VALUES)
        return fail(E_USAGE, "%s: more than %d values were requested at once", path, VALUES);
    snprintf(optional, sizeof optional, "%zu", o->n_optional);
    for (size_t i = 0; i < o->n_values; i++)
        word[2 + i] = o->values[i];
    if (o->smooth <= 0 || o->n_values)
        TRY(reader_ask(&(struct reader_question){.program = "hoodoo-read",
                                                 .kind = "vdb.at",
                                                 .path = path,
                                                 .argument = word,
                                                 .input = m->vertex,
                                                 .n_input = 3 * sizeof(float) * m->n_vertices},
                       &answer));
    TRY(memory_alloc(3 * m->n_vertices, sizeof *out->normal, "normals", &out->normal));
    if (o->smooth > 0)
        trimesh_normals(m, out->normal);
    else
        TRY(reader_take(&answer, out->normal, 3 * m->n_vertices * sizeof *out->normal));
    if (o->n_values)
        TRY(memory_alloc(o->n_values * m->n_vertices, sizeof *out->value, "values", &out->value));
    for (size_t k = 0; k < o->n_values; k++)
        TRY(reader_take(&answer, out->value + k * m->n_vertices, m->n_vertices * sizeof *out->value));
done:
    reader_end(&answer);
    return st;
}

status vdb_mesh_make(const char *path, const struct vdb_mesh_options *options, struct vdb_mesh *out)
{
    status st = OK;
    struct trimesh m = {0};
    double voxel = 0;
    *out = (struct vdb_mesh){0};
    TRY(march(path, &m, &voxel));
    TRY(in_file(path, work_on(&m, options, voxel, &out->label)));
    TRY(read_values(path, &m, options, out));
    out->n_vertices = m.n_vertices;
    out->n_triangles = m.n_triangles;
    out->vertex = m.vertex;
    out->triangle = m.triangle;
    m = (struct trimesh){0};
done:
    trimesh_free(&m);
    if (st != OK)
        vdb_mesh_free(out);
    return st;
}

status vdb_mesh_read(const char *path, double adaptivity, const char *const *values, size_t n_values,
                     size_t n_optional, struct vdb_mesh *out)
{
    const struct vdb_mesh_options options = {
        .adaptivity = adaptivity, .values = values, .n_values = n_values, .n_optional = n_optional};
    return vdb_mesh_make(path, &options, out);
}

void vdb_mesh_free(struct vdb_mesh *mesh)
{
    free(mesh->vertex);
    free(mesh->normal);
    free(mesh->triangle);
    free(mesh->value);
    free(mesh->label);
    *mesh = (struct vdb_mesh){0};
}
