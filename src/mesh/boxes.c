#include "mesh/boxes.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "mesh/apart.h"

enum { MOST_CELLS = 200 }; /* along an axis */

void boxes_corners(const struct trimesh *mesh, const uint32_t corner[3], double out[3][3])
{
    for (int c = 0; c < 3; c++)
        for (int d = 0; d < 3; d++)
            out[c][d] = (double)mesh->vertex[3 * (size_t)corner[c] + (size_t)d];
}

void boxes_of(const struct trimesh *mesh, const uint32_t corner[3], float out[6])
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

bool boxes_apart(const struct trimesh *mesh, const uint32_t a[3], const uint32_t b[3])
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
    boxes_corners(mesh, p, x);
    boxes_corners(mesh, q, y);
    return triangles_apart((const double(*)[3])x, (const double(*)[3])y, shared);
}

static void cells_of(const struct boxes *boxes, const float box[6], int16_t cell[6])
{
    for (int e = 0; e < 6; e++) {
        int d = e % 3;
        double c = floor(((double)box[e] - boxes->low[d]) / boxes->cell);
        cell[e] = (int16_t)fmin(fmax(c, 0), boxes->n[d] - 1);
    }
}

status boxes_add(struct boxes *boxes, uint32_t t)
{
    status st = OK;
    int16_t now[6], *was = boxes->in[t];
    boxes_of(boxes->mesh, boxes->mesh->triangle + 3 * (size_t)t, boxes->box[t]);
    cells_of(boxes, boxes->box[t], now);
    for (int z = now[2]; z <= now[5]; z++)
        for (int y = now[1]; y <= now[4]; y++)
            for (int x = now[0]; x <= now[3]; x++) {
                if (x >= was[0] && x <= was[3] && y >= was[1] && y <= was[4] && z >= was[2] && z <= was[5])
                    continue;
                struct boxes_list *l =
                    &boxes->list[((size_t)z * (size_t)boxes->n[1] + (size_t)y) * (size_t)boxes->n[0] +
                                 (size_t)x];
                TRY(memory_grow(&l->triangle, &l->capacity, l->n + 1, sizeof *l->triangle,
                                "the triangle grid"));
                l->triangle[l->n++] = t;
            }
    memcpy(was, now, sizeof now);
done:
    return st;
}

void boxes_remove(struct boxes *boxes, uint32_t t)
{
    for (int d = 0; d < 3; d++) {
        boxes->box[t][d] = INFINITY;
        boxes->box[t][3 + d] = -INFINITY;
    }
}

status boxes_create(struct boxes *boxes, const struct trimesh *mesh, double cell)
{
    status st = OK;
    double high[3];
    *boxes = (struct boxes){.mesh = mesh, .cell = cell};
    for (int d = 0; d < 3; d++) {
        boxes->low[d] = INFINITY;
        high[d] = -INFINITY;
        for (size_t v = 0; v < mesh->n_vertices; v++) {
            boxes->low[d] = fmin(boxes->low[d], (double)mesh->vertex[3 * v + (size_t)d]);
            high[d] = fmax(high[d], (double)mesh->vertex[3 * v + (size_t)d]);
        }
        boxes->cell = fmax(boxes->cell, (high[d] - boxes->low[d]) / MOST_CELLS);
    }
    for (int d = 0; d < 3; d++)
        boxes->n[d] = mesh->n_vertices ? (int)floor((high[d] - boxes->low[d]) / boxes->cell) + 1 : 1;
    TRY(memory_alloc((size_t)boxes->n[0] * (size_t)boxes->n[1] * (size_t)boxes->n[2], sizeof *boxes->list,
                     "the triangle grid", &boxes->list));
    TRY(memory_alloc(mesh->n_triangles, sizeof *boxes->in, "the triangle grid", &boxes->in));
    TRY(memory_alloc(mesh->n_triangles, sizeof *boxes->box, "the triangle grid", &boxes->box));
    for (size_t t = 0; t < mesh->n_triangles; t++) {
        for (int e = 0; e < 6; e++)
            boxes->in[t][e] = e < 3 ? INT16_MAX : -1;
        TRY(boxes_add(boxes, (uint32_t)t));
    }
done:
    if (st != OK)
        boxes_destroy(boxes);
    return st;
}

void boxes_destroy(struct boxes *boxes)
{
    size_t cells = boxes->list ? (size_t)boxes->n[0] * (size_t)boxes->n[1] * (size_t)boxes->n[2] : 0;
    for (size_t c = 0; c < cells; c++)
        free(boxes->list[c].triangle);
    free(boxes->list);
    free(boxes->in);
    free(boxes->box);
    *boxes = (struct boxes){0};
}

status boxes_find(const struct boxes *boxes, const float box[6], struct boxes_found *found)
{
    status st = OK;
    int16_t c[6];
    cells_of(boxes, box, c);
    for (int z = c[2]; z <= c[5]; z++)
        for (int y = c[1]; y <= c[4]; y++)
            for (int x = c[0]; x <= c[3]; x++) {
                const struct boxes_list *l =
                    &boxes->list[((size_t)z * (size_t)boxes->n[1] + (size_t)y) * (size_t)boxes->n[0] +
                                 (size_t)x];
                TRY(memory_grow(&found->triangle, &found->capacity, found->n + l->n, sizeof *found->triangle,
                                "the triangle grid"));
                for (size_t i = 0; i < l->n; i++) {
                    const float *b = boxes->box[l->triangle[i]];
                    if (b[0] <= box[3] && b[3] >= box[0] && b[1] <= box[4] && b[4] >= box[1] &&
                        b[2] <= box[5] && b[5] >= box[2])
                        found->triangle[found->n++] = l->triangle[i];
                }
            }
done:
    return st;
}
