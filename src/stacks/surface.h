/* The smooth surface of a set of the stacks' materials: their indicator function convolved with a box (Arches 3.3).
 *
 *   f(p) = V(p) / (4 sigma^3) - 1,   V: the volume of these materials in the cube of half-width sigma around p
 *
 * f is 1 where the cube is full of them, -1 where it contains none, and 0 on the surface. On a vertical line f is piecewise linear, so
 * that its roots are exact. Outside of the grid the outermost stacks continue; below the floor the lowest layer does.
 */
#ifndef HOODOO_SURFACE_H
#define HOODOO_SURFACE_H

#include <stdbool.h>

#include "stacks/stacks.h"

enum { SURFACE_WIDEST = 8 }; /* the largest sigma, in cells */

struct surface {
    const struct stacks *stacks;
    uint32_t set; /* of materials, a bit each */
    double sigma; /* m; 1/64 to SURFACE_WIDEST cells */
};

/* f(p). */
double surface_at(const struct surface *s, const double p[3]);

/* The gradient of f at p, from the areas of the materials on the faces of the cube. It points into the material. */
void surface_gradient(const struct surface *s, const double p[3], double gradient[3]);

/* Unit normal at p, out of the material; up where the gradient is 0. */
void surface_normal(const struct surface *s, const double p[3], double normal[3]);

/* f on the vertical line through (x, y): linear between the ascending z[k]; f[0] below, f[n - 1] above. */
struct profile {
    size_t n, capacity;
    double *z, *f;
    struct profile_event *event;
    size_t n_events, event_capacity;
};

MUST_USE status surface_profile(const struct surface *s, double x, double y, struct profile *p);
double profile_at(const struct profile *p, double z);
void profile_free(struct profile *p);

/* Projects p onto f = 0: by Newton steps along the gradient, and by the nearest root on its vertical line where the gradient is 0. *found:
 * false if that line has no root. E_MEMORY. */
MUST_USE status surface_project(const struct surface *s, double p[3], bool *found);

/* A box of n points, from index `first` on, of the lattice origin + (i, j, k) h. */
struct surface_box {
    double origin[3], h; /* m */
    int first[3], n[3];
};

/* A buffer that surface_sample() reuses, one per thread. Start with {0}; free(line) at the end. */
struct surface_scratch {
    float *line;
    size_t capacity;
};

/* share[nz][ny][nx] = (f + 1) / 2, the share of the cube that the materials fill, at the points of `box`. The value of a point depends
 * on its index in the lattice only. E_MEMORY. */
MUST_USE status surface_sample(const struct surface *s, const struct surface_box *box,
                               struct surface_scratch *scratch, float *share);

/* The surface area of each material that faces air or water within sigma of p, m2 (Arches figure 21): tops, undersides and walls. */
void surface_visible(const struct surface *s, const double p[3], double area[MATERIALS_MAX]);

#endif
