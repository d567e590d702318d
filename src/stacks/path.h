/* Paths of tools: a graph of points with radii, as smooth arcs cut into short pieces, and closed spline
 * profiles along them. */
#ifndef HOODOO_PATH_H
#define HOODOO_PATH_H

#include "job/job.h"
#include "stacks/surface.h"

struct path_end {
    double at[3], radius;
    double along[3], side[3], up[3]; /* unit: the path's direction; across it; the profile's second axis */
    double share;                    /* of the way from the first point to the farthest */
};

struct path_piece {
    struct path_end end[2];
    bool first, last;    /* the path begins, ends here: it is cut straight */
    double lo[3], hi[3]; /* what it may reach lies in this box */
};

enum { PROFILE_POINTS = 64, PROFILE_STEPS = 17 };

struct path {
    size_t n, capacity;
    struct path_piece *piece;
    bool round;          /* no profile: a circle */
    double lo[2], hi[2]; /* the profiles' rectangle, in radii */
    struct profile_edge {
        double x, y, ex, ey, inverse, slope; /* from (x, y) by (ex, ey); 1 / its length squared; ex / ey */
    } profile[PROFILE_STEPS][PROFILE_POINTS];
    /* Pieces by blocks of 8 x 8 stacks that they reach. */
    int blocks[2];
    uint32_t *first, *list;
};

enum { PATH_BLOCK = 8 };

/* The pieces of the operation's path that lie between the shares from..to of its length. `surface`: points
 * are moved onto it and profiles turned to its normal; NULL: they stay where they are, and up is up. `reach`:
 * beyond the profile, in radii. Single points are pieces without length. */
MUST_USE status path_create(const struct job_operation *op, const struct surface *surface,
                            const struct stacks *s, double from, double to, double reach, struct path *out);
void path_destroy(struct path *p);

/* Distance to the swept volume, m: negative inside; outside, up or down the line through x, the swept volume
 * is no nearer. Of the pieces that reach stack (i, j), in which x lies; HUGE_VAL if there are none. *radius:
 * the path's there. */
double path_distance(const struct path *p, int i, int j, const double x[3], double *radius);

/* Heights between which pieces may reach x, in stack (i, j); false: nowhere. */
bool path_heights(const struct path *p, int i, int j, const double x[2], double *lo, double *hi);

/* The stacks that pieces may reach: hi < lo if none. */
void path_bounds(const struct path *p, int lo[2], int hi[2]);

#endif
