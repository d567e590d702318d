/* The transform of a node of the scene: its scale, rotation and translation, and those of all nodes above it. */
#ifndef HOODOO_SHAPE_PLACEMENT_H
#define HOODOO_SHAPE_PLACEMENT_H

#include <stdbool.h>

#include "job/job.h"

struct placement {
    double world_from_local[3][4], local_from_world[3][4];
    double min_scale; /* a distance d in local space is at least min_scale * d in the world */
    bool inert;
};

struct placement placement_identity(void);

/* Scaled, then rotated, then moved, then placed at `parent`. */
struct placement placement_transform(const struct placement *parent, const double scale[3],
                                     const double rotate_deg[3], const double translate_m[3]);

/* The placement of `node`, a child of a node placed at `parent`: composes the transforms; inert if either is. */
struct placement placement_child(const struct placement *parent, const struct job_node *node);

/* The ratio of a volume in the world to that in local space. */
double placement_volume_scale(const struct placement *place);

/* out = m x, for an affine 3 x 4 matrix. */
void placement_apply(const double m[3][4], const double x[3], double out[3]);

/* Extends the world box min..max by the local box lo..hi. */
void placement_box(const struct placement *place, const double lo[3], const double hi[3], double min[3],
                   double max[3]);

/* Extends the local box lo..hi by the world box min..max. */
void placement_box_local(const struct placement *place, const double min[3], const double max[3],
                         double lo[3], double hi[3]);

#endif
