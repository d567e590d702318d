#include "shape/voxel_shape.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "shape/probes.h"
#include "shape/voxel_file.h"

struct plane {
    float n[3], offset; /* inside where n x <= offset, x within the unit voxel */
};

struct voxel_shape {
    struct voxel_grid grid;
    /* [voxels]: how many voxels away, by the largest coordinate, the nearest voxel is that is not full as this one, or not empty
     * as this one; 0 if this one is partly rock; at most FAR */
    uint8_t *near;
    uint32_t *first; /* [rows + 1]: planes before each row along x */
    struct plane *plane;
};

enum { FAR = 255 };

/* The smallest distance, in voxels: points are never on the surface, and the sign is exact. */
static const double TINY = 1e-9;

static size_t number(const struct voxel_grid *g, int i, int j, int k)
{
    return ((size_t)k * (size_t)g->n[1] + (size_t)j) * (size_t)g->n[0] + (size_t)i;
}

static bool is_partial(unsigned parts)
{
    return parts > 0 && parts < PROBES;
}

/* ---- distances in voxels */

/* Takes the neighbours on the near side (sign -1) or the far side (1) of voxel (i, j, k), in raster order, into account. Beyond the grid is
 * air. */
static void look_back(struct voxel_shape *v, int i, int j, int k, int sign)
{
    const struct voxel_grid *g = &v->grid;
    const size_t at = number(g, i, j, k);
    unsigned least = v->near[at];
    for (int d = 0; d < 13 && least > 0; d++) { /* 13 of the 26 neighbours come before a voxel */
        const int x = i + sign * (1 - d % 3), y = j + sign * (1 - d / 3 % 3), z = k + sign * (1 - d / 9);
        const bool outside = x < 0 || y < 0 || z < 0 || x >= g->n[0] || y >= g->n[1] || z >= g->n[2];
        const unsigned there = outside ? 0 : g->parts[number(g, x, y, z)];
        const unsigned near = there != g->parts[at] ? 1 : outside ? FAR : v->near[number(g, x, y, z)] + 1u;
        least = near < least ? near : least;
    }
    v->near[at] = (uint8_t)least;
}

static status find_near(struct voxel_shape *v)
{
    status st = OK;
    const int *n = v->grid.n;
    const size_t total = number(&v->grid, 0, 0, n[2]);
    TRY(memory_alloc(total, 1, "voxels", &v->near));
    for (size_t at = 0; at < total; at++)
        v->near[at] = is_partial(v->grid.parts[at]) ? 0 : FAR;
    for (int k = 0; k < n[2]; k++)
        for (int j = 0; j < n[1]; j++)
            for (int i = 0; i < n[0]; i++)
                look_back(v, i, j, k, -1);
    for (int k = n[2] - 1; k >= 0; k--)
        for (int j = n[1] - 1; j >= 0; j--)
            for (int i = n[0] - 1; i >= 0; i--)
                look_back(v, i, j, k, 1);
done:
    return st;
}

/* ---- planes */

/* The direction in which there is less rock. A little is added so that no two probes are equally far along it. */
static void find_normal(const struct voxel_grid *g, const int at[3], float out[3])
{
    static const double tilt[3] = {0.0013, 0.0029, 0.0047};
    double n[3] = {0, 0, 0}, length = 0;
    for (int c = 0; c < 27; c++) {
        const int d[3] = {c % 3 - 1, c / 3 % 3 - 1, c / 9 - 1};
        int x[3], weight = 8;
        for (int a = 0; a < 3; a++) {
            x[a] = at[a] + d[a] < 0 ? 0 : at[a] + d[a] >= g->n[a] ? g->n[a] - 1 : at[a] + d[a];
            weight /= d[a] ? 2 : 1;
        }
        for (int a = 0; a < 3; a++)
            n[a] -= d[a] * weight * (double)g->parts[number(g, x[0], x[1], x[2])];
    }
    for (int a = 0; a < 3; a++)
        length += n[a] * n[a];
    length = sqrt(length);
    for (int a = 0; a < 3; a++)
        out[a] = (float)((length > 0 ? n[a] / length : a == 2) + tilt[a]);
}

static double along(const struct plane *p, const double x[3])
{
    return (double)p->n[0] * x[0] + (double)p->n[1] * x[1] + (double)p->n[2] * x[2];
}

static int by_size(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

static struct plane find_plane(const struct voxel_grid *g, const int at[3])
{
    struct plane p;
    double height[PROBES];
    const unsigned parts = g->parts[number(g, at[0], at[1], at[2])];
    find_normal(g, at, p.n);
    for (int i = 0; i < PROBES; i++)
        height[i] = along(&p, (const double[]){probe(i, 0), probe(i, 1), probe(i, 2)});
    qsort(height, PROBES, sizeof *height, by_size);
    p.offset = (float)((height[parts - 1] + height[parts]) / 2);
    return p;
}

static status find_planes(struct voxel_shape *v)
{
    status st = OK;
    const struct voxel_grid *g = &v->grid;
    const size_t rows = (size_t)g->n[1] * (size_t)g->n[2], row = (size_t)g->n[0];
    TRY(memory_alloc(rows + 1, sizeof *v->first, "voxels", &v->first));
    for (size_t r = 0; r < rows; r++) {
        v->first[r + 1] = v->first[r];
        for (size_t i = 0; i < row; i++)
            v->first[r + 1] += is_partial(g->parts[r * row + i]);
    }
    TRY(memory_alloc(v->first[rows], sizeof *v->plane, "voxels", &v->plane));
#pragma omp parallel for schedule(dynamic, 64)
    for (size_t r = 0; r < rows; r++) {
        struct plane *p = v->plane + v->first[r];
        for (int i = 0; i < g->n[0]; i++)
            if (is_partial(g->parts[r * row + (size_t)i]))
                *p++ =
                    find_plane(g, (const int[]){i, (int)(r % (size_t)g->n[1]), (int)(r / (size_t)g->n[1])});
    }
done:
    return st;
}

/* Of a voxel that is partly rock. */
static const struct plane *plane_of(const struct voxel_shape *v, const int at[3])
{
    const size_t begin = number(&v->grid, 0, at[1], at[2]), row = begin / (size_t)v->grid.n[0];
    const struct plane *p = v->plane + v->first[row];
    for (int i = 0; i < at[0]; i++)
        p += is_partial(v->grid.parts[begin + (size_t)i]);
    return p;
}

/* ---- the shape */

status voxel_shape_create(const struct job_voxels *job, struct voxel_shape **out)
{
    status st = OK;
    struct voxel_shape *v = NULL;
    TRY(memory_alloc(1, sizeof *v, "voxels", &v));
    TRY(voxel_file_read(job->file, &v->grid));
    TRY(find_near(v));
    TRY(find_planes(v));
    *out = v;
    v = NULL;
done:
    voxel_shape_destroy(&v);
    return st;
}

void voxel_shape_destroy(struct voxel_shape **v)
{
    if (!*v)
        return;
    free((*v)->grid.parts);
    free((*v)->near);
    free((*v)->first);
    free((*v)->plane);
    free(*v);
    *v = NULL;
}

void voxel_shape_size(const struct voxel_shape *v, double size[3])
{
    for (int a = 0; a < 3; a++)
        size[a] = v->grid.n[a] * v->grid.h;
}

double voxel_shape_volume(const struct voxel_shape *v)
{
    double sum = 0;
    for (size_t at = 0; at < number(&v->grid, 0, 0, v->grid.n[2]); at++)
        sum += v->grid.parts[at];
    return sum / PROBES * pow(v->grid.h, 3);
}

double voxel_shape_distance(const struct voxel_shape *v, const double x[3])
{
    const struct voxel_grid *g = &v->grid;
    int at[3];
    double in[3], face = 0.5, outside = 0;
    for (int a = 0; a < 3; a++) {
        const double q = x[a] / g->h;
        outside = fmax(outside, fmax(-q, q - g->n[a]));
        at[a] = (int)fmin(fmax(floor(q), 0), g->n[a] - 1);
        in[a] = q - at[a];
        face = fmin(face, fmin(in[a], 1 - in[a]));
    }
    if (outside > 0)
        return outside * g->h;
    face = fmax(face, TINY);
    const size_t voxel = number(g, at[0], at[1], at[2]);
    if (!is_partial(g->parts[voxel])) {
        const double d = v->near[voxel] - 1 + face;
        return (g->parts[voxel] ? -d : d) * g->h;
    }
    const struct plane *p = plane_of(v, at);
    const double d = along(p, in) - (double)p->offset;
    const double size = fmax(fmin(fabs(d) / 1.01, face), TINY); /* the normal is at most 1 % longer than 1 */
    return (d > 0 ? size : -size) * g->h;
}
