/* Rock of arenite that is still deep inside and therefore has no particles yet (particles/deep.h): only a bit per voxel. */
#ifndef HOODOO_ARENITE_DEEP_H
#define HOODOO_ARENITE_DEEP_H

#include "model/arenite.h"

/* Whether rock of this job may be without particles. It may not in shots, with the mpm stress solver, or if joints divide it. */
bool arenite_may_be_deep(const struct job *job);

/* Makes the job's first rock: particles near the surface, and the bits of the *n_deep voxels without particles (*deep is NULL if all
 * rock has particles). The caller frees both. */
MUST_USE status arenite_first_rock(struct arenite *a, struct rock *rock, uint32_t **deep, size_t *n_deep);

/* Creates particles in deep voxels where they have become due: near the surface, everywhere, or in the n voxels that were marked, such as
 * those that blocks_find() found cut off. If any are created, the DERIVED fields are stale. Waits. */
MUST_USE status arenite_add_due(struct arenite *a, enum particles_due what, size_t n);

/* Makes what a frame shows of the rock without particles; the frame owns it, also on error. The stress must be current. Waits. */
MUST_USE status arenite_show_deep(struct arenite *a, struct frame_deep *out);

/* Creates the particles of deep voxels at a cut, with their values. Waits. */
MUST_USE status arenite_add_at_cut(struct arenite *a, const struct field_cut *cut);

/* Its sections of a checkpoint. The particles, whose ids are in *ids, must be restored before. E_CHECKPOINT: the sections are damaged, or
 * made from another scene. */
MUST_USE status arenite_save_deep(struct arenite *a, struct checkpoint *out);
size_t arenite_deep_count(const int voxels[3], const struct checkpoint *c);
MUST_USE status arenite_restore_deep(struct arenite *a, const struct checkpoint *c, struct idset *ids);

/* Adds these sections for a scene; *bits points to those of the voxels, for the caller to fill. */
MUST_USE status arenite_add_deep(const struct scene_source *source, const int voxels[3],
                                 struct checkpoint *out, uint32_t **bits);

/* Finds and checks these sections; *bits points to those of the checkpoint. There must be at least one voxel. */
MUST_USE status arenite_read_deep(const struct scene_source *source, const int voxels[3],
                                  const struct checkpoint *c, struct idset *ids, const uint32_t **bits);

#endif
