/* The smooth surface of some of the stacks' materials: a box convolved with what they fill (Arches 3.3).
 *
 *   f(p) = V(p) / (4 sigma^3) - 1,   V: their volume within sigma of p along every axis
 *
 * f is 1 where the box holds nothing else, -1 where it holds none, 0 on the surface. Along a vertical line it
 * is piecewise linear, so that its roots are exact. Beyond the grid's sides the outermost stacks go on, and
 * below the floor what lies on it.
 */
#ifndef HOODOO_SURFACE_H
#define HOODOO_SURFACE_H

#include <stdbool.h>

#include "stacks/stacks.h"

enum { SURFACE_WIDEST = 8 }; /* sigma in cells */

struct surface {
    const struct stacks *stacks;
    uint32_t set; /* materials, a bit each */
    double sigma; /* m; 1/64 to SURFACE_WIDEST cells */
};

double surface_at(const struct surface *s, const double p[3]);

/* Its derivative there, by the areas on the box's faces. Points into the material. */
void surface_gradient(const struct surface *s, const double p[3], double gradient[3]);

/* Unit normal out of the material at p; up where f is flat. */
void surface_normal(const struct surface *s, const double p[3], double normal[3]);

/* f along the vertical line through (x, y): linear between z[k] ascending, f[0] below, f[n - 1] above. */
struct profile {
    size_t n, capacity;
    double *z, *f;
    struct profile_event *event;
    size_t n_events, event_capacity;
};

MUST_USE status surface_profile(const struct surface *s, double x, double y, struct profile *p);
double profile_at(const struct profile *p, double z);
void profile_free(struct profile *p);

/* Moves p onto f = 0: to the nearest root on its vertical line, then along the gradient. False if that line
 * has none. */
MUST_USE status surface_project(const struct surface *s, double p[3], bool *found);

/* The lattice of points origin + (i, j, k) h, and of it the box of n from `first` on. */
struct surface_box {
    double origin[3], h; /* m */
    int first[3], n[3];
};

/* What sampling needs from call to call, on one thread: {0} to begin with, free(line) at the end. */
struct surface_scratch {
    float *line;
    size_t capacity;
};

/* (f + 1) / 2, the materials' share of the box around a point, at the points of `box`, numbered (k ny + j) nx + i. What a point
 * gets depends on its place in the lattice alone. */
MUST_USE status surface_sample(const struct surface *s, const struct surface_box *box,
                               struct surface_scratch *scratch, float *share);

/* How much surface every material shows to air (and water) within sigma of p, m2 (Arches figure 21): tops,
 * undersides and walls. */
void surface_visible(const struct surface *s, const double p[3], double area[MATERIALS_MAX]);

#endif
