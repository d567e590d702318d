#include "meshinput/mesh.h"

#include <stdlib.h>
#include <string.h>

#include "base/memory.h"

status mesh_add_vertex(struct mesh *mesh, const double x[3])
{
    status st = OK;
    if (mesh->n_vertices >= UINT32_MAX)
        return fail(E_INPUT, "the mesh has more than %u vertices", UINT32_MAX);
    TRY(memory_grow(&mesh->vertex, &mesh->vertex_capacity, mesh->n_vertices + 1, sizeof *mesh->vertex,
                    "a mesh"));
    memcpy(mesh->vertex[mesh->n_vertices++], x, sizeof *mesh->vertex);
done:
    return st;
}

status mesh_add_triangle(struct mesh *mesh, uint32_t a, uint32_t b, uint32_t c)
{
    status st = OK;
    const uint32_t corners[3] = {a, b, c};
    TRY(memory_grow(&mesh->triangle, &mesh->triangle_capacity, mesh->n_triangles + 1, sizeof *mesh->triangle,
                    "a mesh"));
    memcpy(mesh->triangle[mesh->n_triangles++], corners, sizeof corners);
done:
    return st;
}

status mesh_add_value(struct mesh *mesh, double value)
{
    status st = OK;
    TRY(memory_grow(&mesh->value, &mesh->value_capacity, mesh->n_values + 1, sizeof *mesh->value, "a mesh"));
    mesh->value[mesh->n_values++] = (float)value;
done:
    return st;
}

void mesh_free(struct mesh *mesh)
{
    free(mesh->vertex);
    free(mesh->triangle);
    free(mesh->value);
    *mesh = (struct mesh){0};
}
