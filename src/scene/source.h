/* The rock of a job's scene as a function: where its first particles are and what they are like, for any voxels and at any time.
 *
 * Each voxel that holds rock has one particle: jittered inside its voxel by a hash of (seed, voxel), with the share of the voxel
 * inside the shape as its viability; its id is the number of such voxels before it, in the order of all voxels. So the particles
 * of some voxels, made late, are those that they would have been at first.
 *
 * Voxels   are given as bits: 32 of a row along x to a word, rows upwards in y and then z, which start with a word each
 *          (particles/held.h has their number).
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

/* Reads the scene's files and finds its voxels. The job outlives it. Errors as scene_sample()'s. */
MUST_USE status scene_source_create(const struct job *job, struct scene_source **out);
void scene_source_destroy(struct scene_source **source);

/* Particles there are in all. */
size_t scene_source_count(const struct scene_source *source);

/* Which voxels are whole rock that nothing tells from any other: full, bare of plants, and not loose; and how many. */
void scene_source_whole(const struct scene_source *source, uint32_t *bits, size_t *n);

/* The particles of these voxels, so far as they have rock (`bits` NULL: of all that have), but of none in `but` (NULL: none): STATE
 * fields, in voxel order. *rock is the caller's to rock_free(). E_MEMORY says how many they would be. */
MUST_USE status scene_source_make(const struct scene_source *source, const uint32_t *bits,
                                  const uint32_t *but, struct rock *rock);

/* The ids of these voxels' particles, in voxel order. False: not all of the voxels are full of rock. */
bool scene_source_ids(const struct scene_source *source, const uint32_t *bits, uint32_t *ids);

/* What tells one scene from another: a hash of which voxels hold rock; and about a thousand of its particles, evenly spread, which
 * the caller frees. */
uint64_t scene_source_hash(const struct scene_source *source);
MUST_USE status scene_source_few(const struct scene_source *source, struct rock *rock);

#endif
