/* The rock of a job's scene as a function: the first particles of any set of voxels, at any time.
 *
 * Each voxel that contains rock has one particle (scene.h), whose id is the number of such voxels before it in voxel order. So particles
 * that are made late are the same as if they had been made at the start.
 *
 * Voxel sets   are given as the bits of a struct voxel_set (particles/voxel_set.h).
 */
#ifndef HOODOO_SOURCE_H
#define HOODOO_SOURCE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "base/status.h"
#include "job/job.h"
#include "particles/rock.h"

struct scene_source;

/* Reads the scene's files and finds its voxels. The job must outlive the source. Errors of scene_sample(). */
MUST_USE status scene_source_create(const struct job *job, struct scene_source **out);
void scene_source_destroy(struct scene_source **source);

/* The number of all particles. */
size_t scene_source_count(const struct scene_source *source);

/* Sets `bits` to the uniform voxels, full of rock, without plants and not loose, and *n to their number. */
void scene_source_uniform(const struct scene_source *source, uint32_t *bits, size_t *n);

/* Makes the particles of the voxels in `bits` (NULL: all) that contain rock, except those in `but` (NULL: none): STATE fields, in voxel
 * order. Free *rock with rock_free(). E_MEMORY, with the number of particles. */
MUST_USE status scene_source_particles(const struct scene_source *source, const uint32_t *bits,
                                       const uint32_t *but, struct rock *rock);

/* The ids of these voxels' particles, in voxel order. False: some of the voxels are not full of rock. */
bool scene_source_ids(const struct scene_source *source, const uint32_t *bits, uint32_t *ids);

/* Whether a voxel contains rock. */
bool scene_source_has(const struct scene_source *source, const int voxel[3]);

/* The position of the particle of a voxel, whether it contains rock or not: its centre plus a jitter that depends on seed and voxel only.
 * P[3] = 0. */
void scene_source_position(const struct scene_source *source, const int voxel[3], float P[4]);

/* A fingerprint of the scene: the hash of its voxel set, and about a thousand evenly spread particles; free *rock with rock_free(). */
uint64_t scene_source_hash(const struct scene_source *source);
MUST_USE status scene_source_sample(const struct scene_source *source, struct rock *rock);

#endif
