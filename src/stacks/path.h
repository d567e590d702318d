/* Paths of tools: a graph of points with radii, joined by Catmull-Rom arcs that are divided into short segments, and closed spline profiles
 * swept along them. */
#ifndef HOODOO_STACKS_PATH_H
#define HOODOO_STACKS_PATH_H

#include "job/job.h"
#include "stacks/surface.h"

struct path_end {
    double at[3], radius;
    double along[3], side[3], up[3]; /* orthonormal: the path's direction and the profile's two axes */
    double share; /* distance along the path from the first point, as a share of the longest, 0..1 */
    double step;  /* where between the first and the last profile of its table, 0..1 */
};

struct path_segment {
    struct path_end end[2];
    bool first, last;    /* the path begins or ends here, with a flat end */
    uint32_t table;      /* of profiles */
    double lo[3], hi[3]; /* m, bounding box of the swept volume */
};

enum { PROFILE_POINTS = 64, PROFILE_STEPS = 17 };

struct path {
    size_t n, capacity;
    struct path_segment *segment;
    bool round;          /* without a profile: a circle */
    double lo[2], hi[2]; /* the profiles' bounding rectangle, in radii */
    struct profile_edge {
        double x, y, ex, ey, inverse, slope; /* start, vector, 1 / length squared, ex / ey */
    } (*profile)[PROFILE_POINTS];            /* [tables][PROFILE_STEPS]: blended from the first to the last */
    /* The segments that reach each block of 8 x 8 stacks: list[first[b] .. first[b + 1]). */
    int blocks[2];
    uint32_t *first, *list;
};

enum { PATH_BLOCK = 8 };

/* Makes the segments of the operation's path with shares in from..to. `surface`: points are projected onto it and profiles rotated to its
 * normal; NULL: points stay where they are and profiles are upright. `reach`: margin around the profile, in radii. Isolated points are
 * segments without length. Free with path_destroy(). E_USAGE: too many segments. E_MEMORY. */
MUST_USE status path_create(const struct job_operation *op, const struct surface *surface,
                            const struct stacks *s, double from, double to, double reach, struct path *out);
void path_destroy(struct path *p);

/* The distance from x to the swept volume, m, negative inside; outside it is a lower bound along the vertical line through x. Only
 * considers segments that reach stack (i, j), which contains x; HUGE_VAL if there are none. *radius: the path's radius there. */
double path_distance(const struct path *p, int i, int j, const double x[3], double *radius);

/* The range of heights in which segments may reach (x[0], x[1]) in stack (i, j); false: nowhere. */
bool path_heights(const struct path *p, int i, int j, const double x[2], double *lo, double *hi);

/* The stacks that segments may reach; hi < lo: none. */
void path_bounds(const struct path *p, int lo[2], int hi[2]);

#endif
