/* Where a function of height is positive on one stack's axis, and the stacks around paths. */
#ifndef HOODOO_ALONG_H
#define HOODOO_ALONG_H

#include "stacks/surface.h"

/* Intervals lo[k]..hi[k] in m, ascending. */
struct intervals {
    size_t n, capacity;
    struct interval {
        double lo, hi;
    } * at;
};

/* A function of height. *skip, 0 before: how much higher one may go without its sign changing, m, as far as
 * it knows. */
typedef double (*along)(void *user, double z, double *skip);

/* Where f > 0 between lo and hi, found by samples at most `step`, or what f lets skip, apart, the breaks of `line` among them (NULL:
 * none), and bisection between them. `pinned`: where the line is 1 or -1 from break to break, f has its sign
 * there and is not asked for in between. */
MUST_USE status intervals_find(double lo, double hi, double step, const struct profile *line, bool pinned,
                               along f, void *user, struct intervals *out);

#endif
