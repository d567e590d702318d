/* Arenite's rock that no weather has come near: it has no particles yet (particles/deep.h). */
#ifndef HOODOO_ARENITE_DEEP_H
#define HOODOO_ARENITE_DEEP_H

#include "model/arenite.h"

/* May a job's rock be without particles? Not where all of it moves, is looked at as material points, or is parted by joints. */
bool arenite_may_be_deep(const struct job *job);

/* The first rock: particles of what has to have some, and bits of the voxels of all other, *n_deep of them; NULL: there are none. The
 * caller frees both. */
MUST_USE status arenite_first_rock(struct arenite *a, struct rock *rock, uint32_t **deep, size_t *n_deep);

/* Particles come to be where they are due; `n` is the number of the chosen ones, such as blocks_find() has found to be cut off. The
 * DERIVED fields are stale where any have come. Waits. */
MUST_USE status arenite_bear(struct arenite *a, enum particles_due what, size_t n);

/* What a frame shows of the rock that has no particles; the frame's to free, finished or not. The stress must be current. Waits. */
MUST_USE status arenite_show_deep(struct arenite *a, struct frame_deep *out);

/* Its sections of a checkpoint. Restoring follows the particles', whose ids are in *ids. E_CHECKPOINT: damaged, or of another
 * scene. */
MUST_USE status arenite_save_deep(struct arenite *a, struct checkpoint *out);
size_t arenite_deep_count(const struct arenite *a, const struct checkpoint *c);
MUST_USE status arenite_restore_deep(struct arenite *a, const struct checkpoint *c, struct idset *ids);

#endif
