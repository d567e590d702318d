#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "meshinput/decode.h"

/* Cutting off ears takes a time quadratic in the number of corners; larger polygons become fans. */
enum { MAX_EARS = 2048 };

status polygon_add(struct polygon *p, uint32_t corner)
{
    status st = OK;
    TRY(memory_grow(&p->corner, &p->capacity, p->n + 1, sizeof *p->corner, "a face"));
    p->corner[p->n++] = corner;
done:
    return st;
}

void polygon_free(struct polygon *p)
{
    free(p->corner);
    *p = (struct polygon){0};
}

/* Twice the area vector of the triangle a, b, c. */
static void normal_of(const double a[3], const double b[3], const double c[3], double n[3])
{
    for (int i = 0; i < 3; i++) {
        const int j = (i + 1) % 3, k = (i + 2) % 3;
        n[i] = (b[j] - a[j]) * (c[k] - a[k]) - (b[k] - a[k]) * (c[j] - a[j]);
    }
}

/* Twice the area of the triangle as seen along `up`, positive if counter-clockwise. */
static double area_along(const struct mesh *m, const double up[3], uint32_t a, uint32_t b, uint32_t c)
{
    double n[3];
    normal_of(m->vertex[a], m->vertex[b], m->vertex[c], n);
    return n[0] * up[0] + n[1] * up[1] + n[2] * up[2];
}

/* The polygon's area vector. Does a fan cover it, that is, does no triangle of the fan point the other way? */
static bool is_fan(const struct mesh *m, const struct polygon *p, double up[3])
{
    double n[3];
    memset(up, 0, 3 * sizeof *up);
    for (size_t i = 2; i < p->n; i++) {
        normal_of(m->vertex[p->corner[0]], m->vertex[p->corner[i - 1]], m->vertex[p->corner[i]], n);
        for (int a = 0; a < 3; a++)
            up[a] += n[a];
    }
    for (size_t i = 2; i < p->n; i++)
        if (area_along(m, up, p->corner[0], p->corner[i - 1], p->corner[i]) < 0)
            return false;
    return true;
}

/* Can the corner i of the n that are left be cut off: is it convex, and is no other corner inside of its triangle? */
static bool is_ear(const struct mesh *m, const uint32_t *left, size_t n, size_t i, const double up[3])
{
    const uint32_t a = left[(i + n - 1) % n], b = left[i], c = left[(i + 1) % n];
    if (area_along(m, up, a, b, c) < 0)
        return false;
    for (size_t k = 0; k < n; k++) {
        const uint32_t x = left[k];
        if (x != a && x != b && x != c && area_along(m, up, a, b, x) >= 0 &&
            area_along(m, up, b, c, x) >= 0 && area_along(m, up, c, a, x) >= 0)
            return false;
    }
    return true;
}

static status cut_ears(struct mesh *m, const struct polygon *p, const double up[3])
{
    status st = OK;
    uint32_t left[MAX_EARS];
    size_t n = p->n, i = 0;
    memcpy(left, p->corner, n * sizeof *left);
    for (size_t tried = 0; n > 3; tried++) {
        i = i < n ? i : 0;
        /* A polygon that crosses itself may have no ear: any corner is cut off then. */
        if (tried < n && !is_ear(m, left, n, i, up)) {
            i++;
            continue;
        }
        TRY(mesh_add_triangle(m, left[(i + n - 1) % n], left[i], left[(i + 1) % n]));
        memmove(left + i, left + i + 1, (n - 1 - i) * sizeof *left);
        n--;
        tried = 0;
    }
    TRY(mesh_add_triangle(m, left[0], left[1], left[2]));
done:
    return st;
}

status mesh_add_polygon(struct mesh *mesh, const struct polygon *p)
{
    status st = OK;
    double up[3];
    bool known = true;
    for (size_t i = 0; i < p->n; i++)
        known &= p->corner[i] < mesh->n_vertices; /* a PLY file may have its faces before its vertices */
    if (p->n > 3 && p->n <= MAX_EARS && known && !is_fan(mesh, p, up))
        return cut_ears(mesh, p, up);
    for (size_t i = 2; i < p->n; i++)
        TRY(mesh_add_triangle(mesh, p->corner[0], p->corner[i - 1], p->corner[i]));
done:
    return st;
}
