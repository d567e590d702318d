#include "mesh/apart.h"

#include <math.h>
#include <string.h>

#include "base/vector.h"

/* Tolerance relative to the size of the triangles, larger than the rounding errors here. Results within it are doubtful. */
static const double DOUBT = 1e-9;

static double largest(const double (*v)[3], int n)
{
    double most = 0;
    for (int i = 0; i < n; i++)
        for (int d = 0; d < 3; d++)
            most = fmax(most, fabs(v[i][d]));
    return most;
}

/* Whether a plane perpendicular to `axis` has all of a on one side and all of b on the other. */
static bool separates(const double axis[3], const double a[3][3], const double b[3][3], double size)
{
    double low[2] = {INFINITY, INFINITY}, high[2] = {-INFINITY, -INFINITY};
    for (int i = 0; i < 3; i++) {
        double s = dot3(axis, a[i]), t = dot3(axis, b[i]);
        low[0] = fmin(low[0], s), high[0] = fmax(high[0], s);
        low[1] = fmin(low[1], t), high[1] = fmax(high[1], t);
    }
    double gap = fmax(low[0] - high[1], low[1] - high[0]);
    return gap > DOUBT * size * sqrt(dot3(axis, axis));
}

/* Triangles without common corners: tests all separating axes, including those within their planes for coplanar triangles. */
static bool apart(const double a[3][3], const double b[3][3])
{
    double p[3][3], q[3][3], e[3][3], f[3][3], n[2][3], axis[3];
    for (int i = 0; i < 3;
         i++) { /* relative to one corner, so that rounding errors scale with the triangles */
        minus3(a[i], a[0], p[i]);
        minus3(b[i], a[0], q[i]);
    }
    double size = fmax(largest((const double(*)[3])p, 3), largest((const double(*)[3])q, 3));
    const double(*s)[3] = (const double(*)[3])p, (*t)[3] = (const double(*)[3])q;
    for (int i = 0; i < 3; i++) {
        minus3(p[(i + 1) % 3], p[i], e[i]);
        minus3(q[(i + 1) % 3], q[i], f[i]);
    }
    cross3(e[0], e[1], n[0]);
    cross3(f[0], f[1], n[1]);
    if (separates(n[0], s, t, size) || separates(n[1], s, t, size))
        return true;
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) {
            cross3(e[i], f[j], axis);
            if (separates(axis, s, t, size))
                return true;
        }
    for (int i = 0; i < 3; i++) {
        cross3(n[0], e[i], axis);
        if (separates(axis, s, t, size))
            return true;
        cross3(n[1], f[i], axis);
        if (separates(axis, s, t, size))
            return true;
    }
    return false;
}

/* The side of the plane perpendicular to `axis` on which x is: -1, 1, or 0 if doubtful. */
static int side(const double axis[3], const double x[3], double size)
{
    double s = dot3(axis, x), doubt = DOUBT * size * sqrt(dot3(axis, axis));
    return s > doubt ? 1 : s < -doubt ? -1 : 0;
}

/* Triangles with one common corner; a and b are their other two corners relative to it. The cones that they span meet only in their apex
 * if a plane through it separates them. It suffices to test planes through an edge of each, perpendicular planes if both are coplanar,
 * and one between them. */
static bool cones_apart(const double a[2][3], const double b[2][3])
{
    double size = fmax(largest(a, 2), largest(b, 2)), n[2][3], axis[3];
    cross3(a[0], a[1], n[0]);
    cross3(b[0], b[1], n[1]);
    if (side(n[0], b[0], size) * side(n[0], b[1], size) > 0 ||
        side(n[1], a[0], size) * side(n[1], a[1], size) > 0)
        return true;
    for (int i = 0; i < 2; i++)
        for (int j = 0; j < 2; j++) {
            cross3(a[i], b[j], axis);
            if (side(axis, a[!i], size) * side(axis, b[!j], size) < 0)
                return true;
        }
    for (int i = 0; i < 2; i++) {
        cross3(n[0], a[i], axis);
        int s = side(axis, a[!i], size);
        if (s * side(axis, b[0], size) < 0 && s * side(axis, b[1], size) < 0)
            return true;
        cross3(n[1], b[i], axis);
        s = side(axis, b[!i], size);
        if (s * side(axis, a[0], size) < 0 && s * side(axis, a[1], size) < 0)
            return true;
    }
    double length[4];
    for (int i = 0; i < 2; i++) {
        length[i] = sqrt(dot3(a[i], a[i]));
        length[2 + i] = sqrt(dot3(b[i], b[i]));
    }
    for (int d = 0; d < 3; d++)
        axis[d] = a[0][d] / length[0] + a[1][d] / length[1] - b[0][d] / length[2] - b[1][d] / length[3];
    return side(axis, a[0], size) > 0 && side(axis, a[1], size) > 0 && side(axis, b[0], size) < 0 &&
           side(axis, b[1], size) < 0;
}

/* Triangles with a common edge: they are either folded onto each other or apart. */
static bool unfolded(const double a[3][3], const double b[3][3])
{
    double e[3], p[3], q[3], n[3], m[3], fold[3];
    minus3(a[1], a[0], e);
    minus3(a[2], a[0], p);
    minus3(b[2], b[0], q);
    cross3(e, p, n);
    cross3(e, q, m);
    cross3(n, m, fold);
    double along = dot3(n, m), lengths = sqrt(dot3(n, n) * dot3(m, m));
    return lengths > 0 && (along < 0 || sqrt(dot3(fold, fold)) > 1e-6 * lengths);
}

bool triangles_apart(const double a[3][3], const double b[3][3], int shared)
{
    double p[2][3], q[2][3];
    switch (shared) {
    case 0:
        return apart(a, b);
    case 1:
        for (int i = 0; i < 2; i++) {
            minus3(a[i + 1], a[0], p[i]);
            minus3(b[i + 1], b[0], q[i]);
        }
        return cones_apart((const double(*)[3])p, (const double(*)[3])q);
    case 2:
        return unfolded(a, b);
    default:
        return false;
    }
}

static double segment_distance2(const double p[3], const double a[3], const double b[3])
{
    double e[3], r[3];
    minus3(b, a, e);
    minus3(p, a, r);
    double length2 = dot3(e, e), t = length2 > 0 ? fmin(fmax(dot3(r, e) / length2, 0), 1) : 0;
    for (int d = 0; d < 3; d++)
        r[d] -= t * e[d];
    return dot3(r, r);
}

double triangle_distance2(const double p[3], const double t[3][3])
{
    double e[3], f[3], n[3], r[3], edge[3], side_of[3];
    minus3(t[1], t[0], e);
    minus3(t[2], t[0], f);
    cross3(e, f, n);
    bool inside = true;
    for (int i = 0; i < 3; i++) {
        minus3(t[(i + 1) % 3], t[i], edge);
        minus3(p, t[i], r);
        cross3(n, edge, side_of);
        inside &= dot3(side_of, r) >= 0;
    }
    if (inside && dot3(n, n) > 0) {
        minus3(p, t[0], r);
        double h = dot3(n, r);
        return h * h / dot3(n, n);
    }
    double least = INFINITY;
    for (int i = 0; i < 3; i++)
        least = fmin(least, segment_distance2(p, t[i], t[(i + 1) % 3]));
    return least;
}
