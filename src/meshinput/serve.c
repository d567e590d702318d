#include "meshinput/serve.h"

#include <stdlib.h>

#include "base/memory.h"
#include "gltf/gltf.h"
#include "meshinput/decode.h"
#include "reader/mesh_part.h"
#include "reader/serve.h"
#include "system/atomic_file.h"

#define MEMORY ((uint64_t)1 << 30)
#define MAX_FILE ((size_t)8 << 30)

/* Finds the buffers in the reader's input. *bytes is the caller's, also on error. */
static status take_buffers(const struct serve_question *q, struct mesh_buffer buffer[GLTF_BUFFERS],
                           size_t *n_buffers, char **bytes)
{
    status st = OK;
    size_t at = 0;
    TRY(memory_alloc((size_t)q->n_input + 1, 1, q->path, bytes));
    TRY(serve_input(q, *bytes, (size_t)q->n_input, 0));
    for (size_t i = 1; i + 1 < q->n_arguments && *n_buffers < GLTF_BUFFERS; i += 2) {
        const size_t n = (size_t)strtoull(q->argument[i + 1], NULL, 10);
        if (n > q->n_input - at)
            return fail(E_INPUT, "%s: the input for its reader is too short", q->path);
        buffer[(*n_buffers)++] = (struct mesh_buffer){q->argument[i], *bytes + at, n};
        at += n;
    }
done:
    return st;
}

static status send(const struct mesh *mesh, struct serve_answer *answer)
{
    status st = OK;
    const struct mesh_part part = {
        .n_vertices = mesh->n_vertices, .n_triangles = mesh->n_triangles, .y_up = mesh->y_up};
    TRY(serve_add_part(answer, &part, sizeof part));
    TRY(serve_add_part(answer, mesh->vertex, mesh->n_vertices * sizeof *mesh->vertex));
    TRY(serve_add_part(answer, mesh->triangle, mesh->n_triangles * sizeof *mesh->triangle));
    if (mesh->value)
        TRY(serve_add_part(answer, mesh->value, mesh->n_vertices * sizeof *mesh->value));
done:
    return st;
}

static status read_mesh(const struct serve_question *q, struct serve_answer *answer)
{
    status st = OK;
    char *bytes = NULL, *input = NULL;
    struct mesh_buffer buffer[GLTF_BUFFERS];
    struct mesh_file file = {.path = q->path, .buffer = buffer};
    struct mesh mesh = {0};
    if (q->n_arguments < 1)
        return fail(E_INPUT, "%s: its reader lacks an argument", q->path);
    TRY(file_read(q->path, MAX_FILE, &bytes, &file.n));
    file.bytes = bytes;
    TRY(take_buffers(q, buffer, &file.n_buffers, &input));
    TRY(mesh_decode(&file, q->argument[0], gltf_import, &mesh));
    TRY(send(&mesh, answer));
done:
    mesh_free(&mesh);
    free(bytes);
    free(input);
    return st;
}

int mesh_serve_main(int argc, char **argv)
{
    static const struct serve_kind kinds[] = {{"mesh", MEMORY, read_mesh}};
    return serve(argc, argv, kinds, sizeof kinds / sizeof *kinds);
}
