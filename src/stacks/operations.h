/* The tools that make terrain (Arches 4): one operation of a job, in one frame, on stacks.
 *
 *   sculpt    f~ = f +- strength (1 - (r / R)^2)^2 around c = v -+ delta R n: moves the surface along its
 *             normal. Within reach, bedrock becomes {f~ > 0} along each stack's axis
 *   sweep     a closed spline profile along a graph of paths: what it holds becomes air, or a material
 *   deposit   a brush, thickest in its middle; lands on what lies below the path
 *   erode     bedrock in reach of a path becomes rock (rho) and sand: all of it, or what is near the surface
 *   fill      water up to a level, in the air connected to a point
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
    double sigma; /* m, of the surface */

    /* Smooth noise of zero mean and unit variance, about `scale` metres coarse, `flatten` times less so in
     * height. */
    double (*noise)(const void *user, double scale, double flatten, const double x[3]);
    const void *user;
};

/* Is the operation at work in this frame? */
bool operation_active(const struct job_operation *op, int frame);

/* Does it. lo..hi: the stacks it may have changed (hi < lo: none). `path` names the operation in errors.
 * E_USAGE: an unknown material. On an error nothing has changed. */
MUST_USE status operation_apply(struct stacks *s, const struct tools *tools, const struct job_operation *op,
                                const char *path, int frame, int lo[2], int hi[2]);

#endif
