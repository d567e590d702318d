/* From a job's scene to the first particles.
 *
 * The domain is cut into voxels of the particle spacing h, eight to a cell of the stress grid; voxel (i, j, k) covers
 * [i h, (i+1) h] and so on, numbered (k ny + j) nx + i. Each voxel that holds rock gets one particle: jittered inside its
 * voxel by a hash of (seed, voxel), with the share of the voxel inside the shape as its viability, so that slanted and
 * shifted faces start where the job puts them, whatever the spacing.
 */
#ifndef HOODOO_SCENE_H
#define HOODOO_SCENE_H

#include <stddef.h>

#include "base/status.h"
#include "job/job.h"
#include "particles/rock.h"

/* Voxels of the domain on each axis: even, at least 2. E_USAGE if they would be more than 2^31 in all. */
MUST_USE status scene_voxels(const struct job *job, int n[3]);

/* A solid: the job's CSG tree with its files read. */
struct solid;
MUST_USE status solid_create(const struct job_node *node, struct solid **out);
void solid_destroy(struct solid **solid);

struct solid_point {
    double distance; /* m, negative inside: exact or a lower bound in size near the surface, exact in sign */
    int inert;       /* inside a part marked inert */
};
struct solid_point solid_at(const struct solid *solid, const double x[3]);

/* Samples the scene: STATE fields only, particles in voxel order, ids in that order, layers by height, noise and paint
 * applied. *rock is the caller's to rock_free().
 * E_USAGE: no rock in the domain, or none that touches the ground. E_INPUT: a file is missing, damaged or hostile. */
MUST_USE status scene_sample(const struct job *job, struct rock *rock);

/* Bytes scene_sample() will need for the particles, and how many there will be, by sampling a coarse grid. */
MUST_USE status scene_estimate(const struct job *job, size_t *n_particles);

#endif
