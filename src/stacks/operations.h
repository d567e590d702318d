/* The tools that shape terrain (Arches 4): applies one operation of a job, for one frame, to stacks. README.md has the equations.
 *
 *   sculpt    f~ = f +- strength (1 - (r / R)^2)^2 around c = v -+ delta R n: moves the surface along its normal. Within R of c bedrock
 *             becomes {f~ > 0}, on each stack's axis
 *   sweep     sweeps a closed spline profile along a graph of paths; the volume becomes air or a material
 *   deposit   a brush, thickest in its centre, drops material on what is below the path
 *   erode     breaks bedrock within reach of a path into rocks (share rho) and sand: all of it, or only near the surface
 *   fill      fills the air connected to a point with water up to a level
 *   noise     f~ = f + strength * noise
 *
 * Nothing slides here: stabilise() follows.
 */
#ifndef HOODOO_OPERATIONS_H
#define HOODOO_OPERATIONS_H

#include "job/job.h"
#include "stacks/surface.h"

struct tools {
    const struct material *table;
    int n_materials;
    double sigma; /* m, half-width of the box filter of the surface */

    /* Smooth noise of zero mean and unit variance, with features of `scale` metres, scale / flatten in height. */
    double (*noise)(const void *user, double scale, double flatten, const double x[3]);
    const void *user;
};

/* Does the operation work in this frame? */
bool operation_active(const struct job_operation *op, int frame);

/* Applies the operation's share of this frame. lo..hi: the stacks that may have changed (hi < lo: none). `path` names the operation in
 * messages. On an error s is unchanged. E_USAGE: an unknown material, or a path that is too fine. E_MEMORY. */
MUST_USE status operation_apply(struct stacks *s, const struct tools *tools, const struct job_operation *op,
                                const char *path, int frame, int lo[2], int hi[2]);

#endif
