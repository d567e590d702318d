/* Rock that weathering has not come near to has no particles: it is a function of the job (scene/source.h) plus a bit per voxel. Its
 * particles are made when the surface comes near, exactly as they would have been made at the start, and then stay.
 *
 * Deep voxels   are occupied and full (fill 1). All voxels within NEAR_REACH + 1 of an empty voxel or of the domain's sides have their
 *               particles before any process reads them (params.h), so that processes at the surface give the same bits as if all
 *               rock had particles.
 * Calling sequence   for each shape: particles_due(); if any are due, the caller makes the rock of the returned bits and passes it to
 *               particles_add().
 */
#ifndef HOODOO_DEEP_H
#define HOODOO_DEEP_H

#include "particles/particles.h"

/* Declares n voxels deep: full of rock, without particles. bits[held_words()] as in particles/bits.glsl. Reindexes the particles. Waits for
 * the device. */
MUST_USE status particles_set_deep(struct gpu *gpu, struct gpu_work *work, struct particles *p,
                                   const uint32_t *bits, size_t n);

/* Marks in p->place the voxels within `reach` of an empty one on every axis. Records only. */
void particles_mark_near(struct gpu *gpu, struct particles *p, uint32_t reach);

/* Finds the *n deep voxels whose particles are due: those near the surface (DUE_NEAR), those whose bits the caller has written to p->flags
 * with their number in *n (DUE_CHOSEN), or all. If *n > 0, writes them to bits[held_words()] (host); they are no longer deep. Waits for
 * the device. */
enum particles_due { DUE_NEAR, DUE_CHOSEN, DUE_ALL };
MUST_USE status particles_due(struct gpu *gpu, struct gpu_work *work, struct particles *p,
                              enum particles_due what, uint32_t *bits, size_t *n);

/* Writes the bits of all deep voxels, which stay deep. Waits for the device. */
MUST_USE status particles_deep_bits(struct gpu *gpu, struct gpu_work *work, struct particles *p,
                                    uint32_t *bits);

/* Makes the buffers large enough for n particles. If they have to grow, DERIVED fields except stress are lost. Waits for the device.
 * E_MEMORY. */
MUST_USE status particles_reserve(struct gpu *gpu, struct particles *p, size_t n);

/* Adds the particles of the voxels that were last due (STATE, and stress if known) and reindexes all particles, also those of which
 * nothing is left. There must be memory for them (particles_reserve()). Waits for the device. */
MUST_USE status particles_add(struct gpu *gpu, struct gpu_work *work, struct particles *p,
                              const struct rock *rock);

#endif
