/* What a frame's shape is like, on the domain's voxels: connected or not, and seen through from the front. */
#ifndef HOODOO_TESTS_SHAPE_H
#define HOODOO_TESTS_SHAPE_H

#include <math.h>
#include <stdint.h>
#include <stdlib.h>

#include "particles/frame.h"

struct shape {
    int n[3];
    double h;
    uint8_t *rock; /* [voxels] */
};

/* The voxels whose middle is inside the surface, without the field's margin. */
static inline struct shape shape_inside(const struct frame_grids *grids, int margin)
{
    struct shape s = {.h = grids->lattice.voxel};
    for (int a = 0; a < 3; a++)
        s.n[a] = grids->lattice.n[a] - 2 * margin;
    s.rock = malloc((size_t)s.n[0] * (size_t)s.n[1] * (size_t)s.n[2]);
    for (int k = 0; k < s.n[2]; k++)
        for (int j = 0; j < s.n[1]; j++)
            for (int i = 0; i < s.n[0]; i++)
                s.rock[((size_t)k * (size_t)s.n[1] + (size_t)j) * (size_t)s.n[0] + (size_t)i] =
                    grid_at(grids, &grids->grid[0], i + margin, j + margin, k + margin) < 0;
    return s;
}

static inline void shape_free(struct shape *s)
{
    free(s->rock);
    s->rock = NULL;
}

/* Marks with 2 what is face-connected to voxels equal to `what` in the box [low, high); returns how many. */
static inline size_t shape_flood(const struct shape *s, uint8_t *mark, uint8_t what, const int low[3],
                                 const int high[3])
{
    size_t n = (size_t)s->n[0] * (size_t)s->n[1] * (size_t)s->n[2], count = 0, top = 0;
    size_t stride[3] = {1, (size_t)s->n[0], (size_t)s->n[0] * (size_t)s->n[1]};
    uint32_t *stack = malloc(n * sizeof *stack);
    for (int k = low[2]; k < high[2]; k++)
        for (int j = low[1]; j < high[1]; j++)
            for (int i = low[0]; i < high[0]; i++) {
                size_t v = (size_t)k * stride[2] + (size_t)j * stride[1] + (size_t)i;
                if (mark[v] == what) {
                    mark[v] = 2;
                    stack[top++] = (uint32_t)v;
                }
            }
    while (top > 0) {
        size_t v = stack[--top];
        count++;
        for (int a = 0; a < 3; a++) {
            int at = (int)(v / stride[a]) % s->n[a];
            for (int side = -1; side <= 1; side += 2)
                if (at + side >= 0 && at + side < s->n[a]) {
                    size_t w = side < 0 ? v - stride[a] : v + stride[a];
                    if (mark[w] == what) {
                        mark[w] = 2;
                        stack[top++] = (uint32_t)w;
                    }
                }
        }
    }
    free(stack);
    return count;
}

/* Is there a way through the rock from one half of the ground (x below the middle) to the other? */
static inline int shape_spans(const struct shape *s)
{
    size_t n = (size_t)s->n[0] * (size_t)s->n[1] * (size_t)s->n[2];
    uint8_t *mark = malloc(n);
    int spans = 0, low[3] = {0, 0, 0}, high[3] = {s->n[0] / 2, s->n[1], 1};
    for (size_t i = 0; i < n; i++)
        mark[i] = s->rock[i];
    shape_flood(s, mark, 1, low, high);
    for (int j = 0; j < s->n[1]; j++)
        for (int i = s->n[0] / 2; i < s->n[0]; i++)
            spans |= mark[(size_t)j * (size_t)s->n[0] + (size_t)i] == 2;
    free(mark);
    return spans;
}

/* Parts of the rock with no face path between them, and how many voxels they have. */
static inline int shape_parts(const struct shape *s, size_t *largest, size_t *all)
{
    size_t n = (size_t)s->n[0] * (size_t)s->n[1] * (size_t)s->n[2];
    uint8_t *mark = malloc(n);
    int parts = 0;
    for (size_t i = 0; i < n; i++)
        mark[i] = s->rock[i];
    *largest = *all = 0;
    for (size_t v = 0; v < n; v++) {
        if (mark[v] != 1)
            continue;
        int low[3] = {(int)(v % (size_t)s->n[0]), (int)(v / (size_t)s->n[0]) % s->n[1],
                      (int)(v / ((size_t)s->n[0] * (size_t)s->n[1]))};
        size_t size = shape_flood(s, mark, 1, low, (int[]){low[0] + 1, low[1] + 1, low[2] + 1});
        *all += size;
        *largest = size > *largest ? size : *largest;
        parts++;
    }
    free(mark);
    return parts;
}

/* The sky that is seen through the rock along y, above `floor` metres, m2: what of the picture from the front
 * is free of rock and closed in by it on the sides and above; at `floor` it counts as closed. */
static inline double shape_window(const struct shape *s, double floor_m)
{
    int low = (int)ceil(floor_m / s->h - 1e-9), nz = s->n[2] - low;
    struct shape front = {.n = {s->n[0], 1, nz}, .h = s->h, .rock = malloc((size_t)s->n[0] * (size_t)nz)};
    size_t free_of_rock = 0, open = 0;
    for (int k = 0; k < nz; k++)
        for (int i = 0; i < s->n[0]; i++) {
            uint8_t any = 0;
            for (int j = 0; j < s->n[1]; j++)
                any |=
                    s->rock[((size_t)(k + low) * (size_t)s->n[1] + (size_t)j) * (size_t)s->n[0] + (size_t)i];
            front.rock[(size_t)k * (size_t)s->n[0] + (size_t)i] = any;
            free_of_rock += !any;
        }
    open += shape_flood(&front, front.rock, 0, (int[]){0, 0, 0}, (int[]){1, 1, nz});
    open += shape_flood(&front, front.rock, 0, (int[]){s->n[0] - 1, 0, 0}, (int[]){s->n[0], 1, nz});
    open += shape_flood(&front, front.rock, 0, (int[]){0, 0, nz - 1}, (int[]){s->n[0], 1, nz});
    free(front.rock);
    return (double)(free_of_rock - open) * s->h * s->h;
}

#endif
