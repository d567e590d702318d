#include "mesh/near.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "mesh/apart.h"

enum { MOST_CELLS = 200 }; /* along an axis */

void near_corners(const struct trimesh *mesh, const uint32_t corner[3], double out[3][3])
{
    for (int c = 0; c < 3; c++)
        for (int d = 0; d < 3; d++)
            out[c][d] = (double)mesh->vertex[3 * (size_t)corner[c] + (size_t)d];
}

void near_box(const struct trimesh *mesh, const uint32_t corner[3], float out[6])
{
    for (int d = 0; d < 3; d++) {
        out[d] = INFINITY;
        out[3 + d] = -INFINITY;
        for (int c = 0; c < 3; c++) {
            float x = mesh->vertex[3 * (size_t)corner[c] + (size_t)d];
            out[d] = fminf(out[d], x);
            out[3 + d] = fmaxf(out[3 + d], x);
        }
    }
}

bool near_apart(const struct trimesh *mesh, const uint32_t a[3], const uint32_t b[3])
{
    uint32_t p[3], q[3];
    bool used[3] = {false};
    double x[3][3], y[3][3];
    int shared = 0, rest = 0;
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            if (a[i] == b[j]) {
                p[shared] = q[shared] = a[i];
                used[j] = true;
                shared++;
            }
    rest = shared;
    for (int i = 0; i < 3 && rest < 3; i++)
        if (a[i] != b[0] && a[i] != b[1] && a[i] != b[2])
            p[rest++] = a[i];
    rest = shared;
    for (int j = 0; j < 3 && rest < 3; j++)
        if (!used[j])
            q[rest++] = b[j];
    near_corners(mesh, p, x);
    near_corners(mesh, q, y);
    return triangles_apart((const double(*)[3])x, (const double(*)[3])y, shared);
}

static void cells_of(const struct near *near, const float box[6], int16_t cell[6])
{
    for (int e = 0; e < 6; e++) {
        int d = e % 3;
        double c = floor(((double)box[e] - near->low[d]) / near->cell);
        cell[e] = (int16_t)fmin(fmax(c, 0), near->n[d] - 1);
    }
}

status near_add(struct near *near, uint32_t t)
{
    status st = OK;
    int16_t now[6], *was = near->in[t];
    near_box(near->mesh, near->mesh->triangle + 3 * (size_t)t, near->box[t]);
    cells_of(near, near->box[t], now);
    for (int z = now[2]; z <= now[5]; z++)
        for (int y = now[1]; y <= now[4]; y++)
            for (int x = now[0]; x <= now[3]; x++) {
                if (x >= was[0] && x <= was[3] && y >= was[1] && y <= was[4] && z >= was[2] && z <= was[5])
                    continue;
                struct near_list *l =
                    &near->list[((size_t)z * (size_t)near->n[1] + (size_t)y) * (size_t)near->n[0] +
                                (size_t)x];
                TRY(memory_grow(&l->triangle, &l->capacity, l->n + 1, sizeof *l->triangle, "near triangles"));
                l->triangle[l->n++] = t;
            }
    memcpy(was, now, sizeof now);
done:
    return st;
}

void near_remove(struct near *near, uint32_t t)
{
    for (int d = 0; d < 3; d++) {
        near->box[t][d] = INFINITY;
        near->box[t][3 + d] = -INFINITY;
    }
}

status near_create(struct near *near, const struct trimesh *mesh, double cell)
{
    status st = OK;
    double high[3];
    *near = (struct near){.mesh = mesh, .cell = cell};
    for (int d = 0; d < 3; d++) {
        near->low[d] = INFINITY;
        high[d] = -INFINITY;
        for (size_t v = 0; v < mesh->n_vertices; v++) {
            near->low[d] = fmin(near->low[d], (double)mesh->vertex[3 * v + (size_t)d]);
            high[d] = fmax(high[d], (double)mesh->vertex[3 * v + (size_t)d]);
        }
        near->cell = fmax(near->cell, (high[d] - near->low[d]) / MOST_CELLS);
    }
    for (int d = 0; d < 3; d++)
        near->n[d] = mesh->n_vertices ? (int)floor((high[d] - near->low[d]) / near->cell) + 1 : 1;
    TRY(memory_alloc((size_t)near->n[0] * (size_t)near->n[1] * (size_t)near->n[2], sizeof *near->list,
                     "near triangles", &near->list));
    TRY(memory_alloc(mesh->n_triangles, sizeof *near->in, "near triangles", &near->in));
    TRY(memory_alloc(mesh->n_triangles, sizeof *near->box, "near triangles", &near->box));
    for (size_t t = 0; t < mesh->n_triangles; t++) {
        for (int e = 0; e < 6; e++)
            near->in[t][e] = e < 3 ? INT16_MAX : -1;
        TRY(near_add(near, (uint32_t)t));
    }
done:
    if (st != OK)
        near_destroy(near);
    return st;
}

void near_destroy(struct near *near)
{
    size_t cells = near->list ? (size_t)near->n[0] * (size_t)near->n[1] * (size_t)near->n[2] : 0;
    for (size_t c = 0; c < cells; c++)
        free(near->list[c].triangle);
    free(near->list);
    free(near->in);
    free(near->box);
    *near = (struct near){0};
}

status near_find(const struct near *near, const float box[6], struct near_found *found)
{
    status st = OK;
    int16_t c[6];
    cells_of(near, box, c);
    for (int z = c[2]; z <= c[5]; z++)
        for (int y = c[1]; y <= c[4]; y++)
            for (int x = c[0]; x <= c[3]; x++) {
                const struct near_list *l =
                    &near->list[((size_t)z * (size_t)near->n[1] + (size_t)y) * (size_t)near->n[0] +
                                (size_t)x];
                TRY(memory_grow(&found->triangle, &found->capacity, found->n + l->n, sizeof *found->triangle,
                                "near triangles"));
                for (size_t i = 0; i < l->n; i++) {
                    const float *b = near->box[l->triangle[i]];
                    if (b[0] <= box[3] && b[3] >= box[0] && b[1] <= box[4] && b[4] >= box[1] &&
                        b[2] <= box[5] && b[5] >= box[2])
                        found->triangle[found->n++] = l->triangle[i];
                }
            }
done:
    return st;
}
