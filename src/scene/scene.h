/* From a job's scene to the first particles.
 *
 * The domain is cut into voxels of the particle spacing h, eight to a cell of the stress grid; voxel (i, j,
 * k) covers [i h, (i+1) h] and so on, numbered (k ny + j) nx + i. Each voxel that holds rock gets one
 * particle: jittered inside its voxel by a hash of (seed, voxel), with the share of the voxel inside the
 * shape as its viability, so that slanted and shifted faces start where the job puts them, whatever the
 * spacing.
 */
#ifndef HOODOO_SCENE_H
#define HOODOO_SCENE_H

#include <stdbool.h>
#include <stddef.h>

#include "base/status.h"
#include "job/job.h"
#include "particles/rock.h"

/* Voxels of the domain on each axis: even, at least 2. E_USAGE if they would be more than 2^31 in all. */
MUST_USE status scene_voxels(const struct job *job, int n[3]);

/* A solid: the job's CSG tree with its files read. Meshes are sampled every `detail` metres (half a particle
 * spacing is right). Distances up to `reach` metres from the surface are wanted; farther out they may stop
 * growing. E_USAGE: a shape without an inside. E_INPUT: a file is missing, damaged or hostile. */
struct solid;
MUST_USE status solid_create(const struct job_node *node, double detail, double reach, struct solid **out);
void solid_destroy(struct solid **solid);

/* What its file holds by the file's own measure, m3 in the world: a closed mesh's signed volume, a heightfield's integral. NAN where
 * it has none, or is no single shape of a file. */
double solid_own_m3(const struct solid *solid);

/* A box around it, m; infinite where a plane leaves it open, min > max where nothing is left. */
void solid_bounds(const struct solid *solid, double min[3], double max[3]);

/* Overlapping parts of a union: inert if any part that holds the point is; outside, as the nearest part. */
struct solid_point {
    double distance;  /* m, negative inside: exact in sign (0: inside), in size exact or a lower bound */
    int inert, loose; /* loose: it lies there as a deposit; found as inert is */
};
struct solid_point solid_at(const struct solid *solid, const double x[3]);

/* What a box of the world, min to max in m, holds of a solid, by the extents of its shapes alone: SOLID_SOME where
 * they do not say. Good for points between the box's faces, at least a billionth of its size off them. */
enum solid_share { SOLID_NONE, SOLID_ALL, SOLID_SOME };
enum solid_share solid_in_box(const struct solid *solid, const double min[3], const double max[3]);

/* Samples the scene: STATE fields only, particles in voxel order, ids in that order, layers by height in the pile
 * of beds, structure (geology/), noise and paint applied. A voxel of which less than 1/64 is rock gets nothing. Equal jobs give equal bits,
 * whatever the threads.
 *
 * Noise   times exp(amplitude * n(P)), n of zero mean and unit variance (noise.h).
 * Paint   entries are laid over each other in order: where one covers fully its factor replaces what was
 * painted before, elsewhere the two are mixed by its weight, the product of its shape's falloff, its image and
 * its noise; a factor of 1 paints nothing. Inert: where the shape holds P and the weight is at least a half.
 * Beds    sources[].bed_m is taken out of the scene along path_m.
 *
 * *rock is the caller's to rock_free().
 * E_USAGE: no rock in the domain, or none that touches the ground. E_INPUT: a file is missing, damaged or
 * hostile. E_MEMORY: says how many particles it would be. */
MUST_USE status scene_sample(const struct job *job, struct rock *rock);

/* The same rock as a grid, for voxels: of each voxel of the domain, its share of rock (0: air) and
 * its rate_factor, at its middle. The caller has room for scene_voxels() of each.
 * Errors as scene_sample()'s; rock that `floats` need not touch the ground. */
MUST_USE status scene_grid(const struct job *job, bool floats, float *share, float *factor);

/* E_USAGE: nothing of the rock, the lowest of which is at z = `lowest` m, stands on the ground. */
status scene_floats(double lowest);

/* What an edit did to the rock. */
struct scene_edited {
    size_t added, carved; /* particles */
    double added_m3;      /* rock put in, in new particles and in those filled up */
};

/* Applies one edit's carve, add and paint, in this order, to the rock's STATE fields, whose arrays are replaced.
 *
 * Carve   a particle loses the share of its voxel that the shape holds, and goes when less than 1/64 is left.
 * Add     an empty voxel gets a particle as in scene_sample(), without the scene's paint; in one that holds less
 *         rock than the shape does, the particle of the lowest id is filled up. New ids are next_id and up.
 * Paint   the factors multiply what particles have.
 *
 * `job` is the job as it is in that frame. E_USAGE, E_INPUT: as scene_sample(). */
MUST_USE status scene_edit(const struct job *job, const struct job_edit *edit, uint64_t next_id,
                           struct rock *rock, struct scene_edited *out);

/* Reads every file and makes every shape of the edits after `frame`, so that what is wrong is said now. */
MUST_USE status scene_edits_check(const struct job *job, int frame);

/* About how many particles scene_sample() and the edits will make, how many of them are at the surface, how many within SCENE_NEAR
 * voxels of it, and at how many ends their rows along x have, from a quarter of a million voxels of each. */
enum { SCENE_NEAR = 8 };
struct scene_size {
    size_t n_particles, n_surface, n_near, n_ends;
    size_t
        n_kept; /* of the particles, those that a run keeps at all: n_particles unless its model says otherwise */
    size_t n_points;
    float (*point)[3]; /* m: those of the looked-at voxels that are rock, in any order; freed with free() */
};

/* Files and shapes fail as in scene_sample(); an empty scene is 0 particles. */
MUST_USE status scene_estimate(const struct job *job, struct scene_size *out);

/* What scene_sample() and, for rock that `floats`, scene_grid() refuse: no rock in the domain, or none on the ground. `size` is
 * scene_estimate()'s. E_USAGE. */
MUST_USE status scene_stands(const struct job *job, bool floats, const struct scene_size *size);

/* The scene's shapes that come from files, each alone: what the file holds by its own measure (or NAN), and what comes of it as it is
 * sampled at the job's spacing, within a percent or so. *out is the caller's to free(). E_USAGE, E_INPUT: as scene_sample(). */
struct scene_input {
    const char *file; /* the job's */
    double own_m3, sampled_m3;
};
MUST_USE status scene_inputs(const struct job *job, struct scene_input **out, size_t *n);

#endif
