/* The intervals of height in which a function is positive, on the axis of a stack. */
#ifndef HOODOO_INTERVALS_H
#define HOODOO_INTERVALS_H

#include "stacks/surface.h"

/* Intervals lo[k]..hi[k] in m, ascending. */
struct intervals {
    size_t n, capacity;
    struct interval {
        double lo, hi;
    } * at;
};

/* A function of height. It may set *skip, 0 before the call, to a distance above z within which its sign surely does not change, m. */
typedef double (*height_function)(void *user, double z, double *skip);

/* Finds where f > 0 in lo..hi. Samples f at most `step`, or *skip if larger, apart and at the breaks of `line` (NULL: none), and finds the
 * roots between samples of different sign. `pinned`: where `line` is 1 or -1 from one break to the next, f has the same sign and is
 * not sampled in between. The caller frees out->at. E_MEMORY. */
MUST_USE status intervals_find(double lo, double hi, double step, const struct profile *line, bool pinned,
                               height_function f, void *user, struct intervals *out);

#endif
