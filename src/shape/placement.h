/* Where a node of the scene stands: the scale, turns and moves of it and of every node above it. */
#ifndef HOODOO_SHAPE_PLACEMENT_H
#define HOODOO_SHAPE_PLACEMENT_H

#include <stdbool.h>

#include "job/job.h"

struct placement {
    double world_from_local[3][4], local_from_world[3][4];
    double shrink; /* a distance d in local space is at least shrink * d in the world */
    bool inert;
};

struct placement placement_identity(void);

/* `node`'s own scale, rotation, translation and inert flag, below `parent`. */
struct placement placement_below(const struct placement *parent, const struct job_node *node);

/* How many times larger volumes are in the world. */
double placement_growth(const struct placement *place);

void placement_apply(const double m[3][4], const double x[3], double out[3]);

/* Widens min..max of the world by the local box lo..hi. */
void placement_box(const struct placement *place, const double lo[3], const double hi[3], double min[3],
                   double max[3]);

/* Widens lo..hi of local space by the world's box min..max. */
void placement_box_local(const struct placement *place, const double min[3], const double max[3],
                         double lo[3], double hi[3]);

#endif
