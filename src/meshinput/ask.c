#include "meshinput/ask.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "gltf/gltf.h"
#include "system/atomic_file.h"

#define MAX_BUFFERS ((size_t)8 << 30)

/* Are all coordinates and values finite and all indices in range? */
static bool is_valid(const struct mesh *mesh)
{
    for (size_t i = 0; i < mesh->n_vertices; i++)
        for (int a = 0; a < 3; a++)
            if (!(fabs(mesh->vertex[i][a]) <= 1e30))
                return false;
    for (size_t i = 0; mesh->value && i < mesh->n_vertices; i++)
        if (!isfinite(mesh->value[i]))
            return false;
    for (size_t t = 0; t < mesh->n_triangles; t++)
        for (int k = 0; k < 3; k++)
            if (mesh->triangle[t][k] >= mesh->n_vertices)
                return false;
    return true;
}

static status take_mesh(struct reader_answer *answer, bool has_value, const struct mesh_part *part,
                        struct mesh *mesh)
{
    status st = OK;
    *mesh = (struct mesh){0};
    if (part->n_vertices > UINT32_MAX || part->n_triangles > UINT32_MAX / 2) {
        st = fail(E_INPUT, "%s: the mesh has more than 2^31 triangles or 2^32 vertices: reduce it",
                  answer->path);
        goto done;
    }
    TRY(reader_take_array(answer, (size_t)part->n_vertices, sizeof *mesh->vertex, &mesh->vertex));
    TRY(reader_take_array(answer, (size_t)part->n_triangles, sizeof *mesh->triangle, &mesh->triangle));
    if (has_value)
        TRY(reader_take_array(answer, (size_t)part->n_vertices, sizeof *mesh->value, &mesh->value));
    mesh->n_vertices = mesh->vertex_capacity = (size_t)part->n_vertices;
    mesh->n_triangles = mesh->triangle_capacity = (size_t)part->n_triangles;
    mesh->n_values = mesh->value_capacity = has_value ? mesh->n_vertices : 0;
    mesh->y_up = part->y_up != 0;
    if (!is_valid(mesh))
        st =
            fail(E_INPUT,
                 "%s: damaged mesh: a number is not finite, or a face refers to a vertex that does not exist",
                 answer->path);
done:
    if (st != OK)
        mesh_free(mesh);
    return st;
}

static status take_head(struct reader_answer *answer, struct mesh_part *part)
{
    const status st = reader_take(answer, part, sizeof *part);
    part->grid[sizeof part->grid - 1] = '\0';
    return st;
}

status mesh_take(struct reader_answer *answer, bool has_value, struct mesh_part *part, struct mesh *mesh)
{
    status st = OK;
    *mesh = (struct mesh){0};
    TRY(take_head(answer, part));
    TRY(take_mesh(answer, has_value, part, mesh));
done:
    return st;
}

void mesh_solid_free(struct mesh_solid *solid)
{
    free(solid->at);
    free(solid->value);
    *solid = (struct mesh_solid){0};
}

static status take_solid(struct reader_answer *answer, struct mesh_solid *out)
{
    enum { FARTHEST = 1 << 24 };
    status st = OK;
    struct solid_part *p = &out->part;
    TRY(reader_take(answer, p, sizeof *p));
    bool good = p->n < UINT32_MAX && p->voxel > 0 && p->voxel < 1e9 && p->filled >= 0 && p->filled < 1e18;
    for (int a = 0; a < 3; a++)
        good &= fabs(p->origin[a]) < 1e9;
    if (!good)
        return reader_bad_answer(answer);
    TRY(reader_take_array(answer, (size_t)p->n, sizeof *out->at, &out->at));
    TRY(reader_take_array(answer, (size_t)p->n, sizeof *out->value, &out->value));
    for (size_t i = 0; i < p->n && good; i++)
        good = fabsf(out->value[i]) <= 8 && abs(out->at[i][0]) < FARTHEST && abs(out->at[i][1]) < FARTHEST &&
               abs(out->at[i][2]) < FARTHEST;
    if (!good)
        st = reader_bad_answer(answer);
done:
    return st;
}

status mesh_take_volume(struct reader_answer *answer, struct mesh_part *part, struct mesh *mesh,
                        struct mesh_solid *solid)
{
    status st = OK;
    *mesh = (struct mesh){0};
    *solid = (struct mesh_solid){0};
    TRY(take_head(answer, part));
    TRY(part->is_solid ? take_solid(answer, solid) : take_mesh(answer, false, part, mesh));
done:
    if (st != OK)
        mesh_solid_free(solid);
    return st;
}

/* The buffers in other files, one behind the other: the input of the reader, and for each its name and size as arguments. */
struct beside {
    char *bytes;
    size_t n, capacity, n_words;
    const char *word[2 * GLTF_BUFFERS];
    char size[GLTF_BUFFERS][24];
};

static status read_buffers(const char *path, const struct gltf_buffers *buffers, struct beside *out)
{
    status st = OK;
    char *bytes = NULL;
    size_t size = 0;
    for (size_t i = 0; i < buffers->n; i++) {
        if (file_read(buffers->path[i], MAX_BUFFERS - out->n, &bytes, &size) != OK) {
            char why[512];
            snprintf(why, sizeof why, "%s", status_message());
            return fail(E_INPUT, "%s: its buffer cannot be read: %s", path, why);
        }
        TRY(memory_grow(&out->bytes, &out->capacity, out->n + size, 1, "the buffers of a mesh"));
        memcpy(out->bytes + out->n, bytes, size);
        out->n += size;
        snprintf(out->size[i], sizeof out->size[i], "%zu", size);
        out->word[out->n_words++] = buffers->uri[i];
        out->word[out->n_words++] = out->size[i];
        free(bytes);
        bytes = NULL;
    }
done:
    free(bytes);
    return st;
}

status mesh_read(const char *path, const char *attribute, struct mesh *mesh)
{
    status st = OK;
    struct gltf_buffers buffers = {0};
    struct beside beside = {0};
    struct reader_answer answer = {0};
    struct mesh_part part;
    const char *argument[1 + 2 * GLTF_BUFFERS + 1] = {attribute ? attribute : ""};
    *mesh = (struct mesh){0};
    TRY(gltf_buffers(path, &buffers));
    TRY(read_buffers(path, &buffers, &beside));
    memcpy(argument + 1, beside.word, beside.n_words * sizeof *argument);
    TRY(reader_ask(&(struct reader_question){.program = "hoodoo-read-mesh",
                                             .kind = "mesh",
                                             .path = path,
                                             .argument = argument,
                                             .input = beside.bytes,
                                             .n_input = beside.n},
                   &answer));
    TRY(mesh_take(&answer, attribute != NULL, &part, mesh));
done:
    reader_end(&answer);
    gltf_buffers_free(&buffers);
    free(beside.bytes);
    return st;
}

status mesh_read_volume(const char *path, const char *const *argument, struct mesh_part *part,
                        struct mesh *mesh, struct mesh_solid *solid)
{
    status st = OK;
    struct reader_answer answer = {0};
    *mesh = (struct mesh){0};
    *solid = (struct mesh_solid){0};
    TRY(reader_ask(
        &(struct reader_question){
            .program = "hoodoo-read", .kind = "vdb.shape", .path = path, .argument = argument},
        &answer));
    TRY(mesh_take_volume(&answer, part, mesh, solid));
done:
    reader_end(&answer);
    return st;
}
