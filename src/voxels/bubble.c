#include "voxels/bubble.h"

#include <math.h>
#include <stdlib.h>

/* Whether the bubble contains the voxel at the offset d. `radius`: in voxels. */
static bool holds(const struct job_bubble *job, double radius, const int d[3])
{
    double sum = 0, z = d[2] - job->offset[2] * radius;
    for (int a = 0; a < 3; a++) {
        double x = (d[a] - job->offset[a] * radius) / (job->stretch[a] * radius);
        /* A gumdrop is round above its centre and a cylinder below, down to its base. */
        if (job->shape == BUBBLE_GUMDROP && a == 2 && x < 0)
            x = 0;
        sum += x * x;
    }
    if (job->shape == BUBBLE_GUMDROP && z < -job->base * radius * job->stretch[2] - 1e-9)
        return false;
    return sum <= 1 + 1e-9;
}

status bubble_create(const struct job_bubble *job, double h, struct bubble *b)
{
    double radius = job->radius_m / h, far = 0;
    for (int a = 0; a < 3; a++)
        far = fmax(far, (job->stretch[a] + fabs(job->offset[a])) * radius);
    if (far >= BUBBLE_REACH_MAX + 1)
        return fail(
            E_USAGE,
            "bubble: it reaches %.1f voxels, and at most %d are possible: raise domain.spacing_m above %.3g m, or make the bubble smaller",
            far, BUBBLE_REACH_MAX, h * far / (BUBBLE_REACH_MAX + 1));
    const int m = (int)far;
    *b = (struct bubble){0};
    for (int dz = -m; dz <= m; dz++)
        for (int dy = -m; dy <= m; dy++) {
            int low = m + 1, high = -m - 1;
            for (int dx = -m; dx <= m; dx++)
                if (holds(job, radius, (const int[]){dx, dy, dz})) {
                    low = dx < low ? dx : low;
                    high = dx;
                }
            if (low > high)
                continue;
            b->row[b->n_rows++] = (struct bubble_row){(int8_t)dy, (int8_t)dz, (int8_t)low, (int8_t)high};
            b->n += (uint32_t)(high - low + 1);
            b->reach = abs(dy) > b->reach ? abs(dy) : b->reach;
            b->reach = abs(dz) > b->reach ? abs(dz) : b->reach;
        }
    if (b->n < 2)
        return fail(
            E_USAGE,
            "bubble: a radius of %g m contains no neighbour of its voxel at %g m: lower domain.spacing_m, or make the bubble larger",
            job->radius_m, h);
    return OK;
}

/* Share of a bubble that is beyond a flat face across `axis`, for a voxel below `depth` others; -1: for the first voxel outside. */
static double flat_air(const struct bubble *b, int axis, int side, int depth)
{
    uint32_t air = 0;
    for (int r = 0; r < b->n_rows; r++)
        for (int dx = b->row[r].low; dx <= b->row[r].high; dx++) {
            const int d[3] = {dx, b->row[r].dy, b->row[r].dz};
            air += side * d[axis] > depth;
        }
    return (double)air / b->n;
}

struct bubble_rate bubble_rate(const struct bubble *b, double threshold, int depth)
{
    double flat = 0, speed = 0;
    for (int face = 0; face < 6; face++) {
        int axis = face / 2, side = face % 2 ? -1 : 1;
        flat += (flat_air(b, axis, side, -1) + flat_air(b, axis, side, 0)) / 12;
        for (int d = 0; d < depth; d++)
            speed += flat_air(b, axis, side, d) / 6;
    }
    speed /= flat * depth;
    return (struct bubble_rate){1 / (flat * b->n * depth), (speed - (1 - threshold)) / depth};
}
