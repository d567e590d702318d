/* Rock that no weather has come near has no particles: it is a function of the job (scene/source.h), and a bit for each voxel
 * says where. Its particles come to be when the surface comes near, exactly as they would have been; then they stay.
 *
 * Deep voxels   are occupied, and whole: their fill is 1. Every voxel within NEAR_REACH + 1 of an empty one, or of the domain's
 *               sides, has its particles before anything looks at it (params.h); so everything that is done at the surface
 *               finds what it would find if all rock had particles, and has the same bits.
 * Calling sequence   for each shape: particles_due(); if there are any, the rock that the caller makes of the bits goes to
 *               particles_add().
 */
#ifndef HOODOO_DEEP_H
#define HOODOO_DEEP_H

#include "particles/particles.h"

/* Words of bits (particles/bits.glsl) with `n` voxels set, all of them whole rock that has no particle. Orders the particles
 * anew. Waits. */
MUST_USE status particles_set_deep(struct gpu *gpu, struct gpu_work *work, struct particles *p,
                                   const uint32_t *bits, size_t n);

/* Records p->place: the voxels within `reach` of an empty one on every axis. */
void particles_near(struct gpu *gpu, struct particles *p, uint32_t reach);

/* The deep voxels whose particles are due, *n of them: those that the surface has come near to; those of which the caller has put the
 * bits into p->flags, and the number into *n; or all. Unless there are none their bits go to `bits` (host, held_words()), and they
 * are not deep any more. Waits. */
enum particles_due { DUE_NEAR, DUE_CHOSEN, DUE_ALL };
MUST_USE status particles_due(struct gpu *gpu, struct gpu_work *work, struct particles *p,
                              enum particles_due what, uint32_t *bits, size_t *n);

/* Those of all deep voxels, which stay deep. Waits. */
MUST_USE status particles_deep_bits(struct gpu *gpu, struct gpu_work *work, struct particles *p,
                                    uint32_t *bits);

/* Room for n particles in all. What is DERIVED is lost where it has to grow, but for stress. Waits. */
MUST_USE status particles_reserve(struct gpu *gpu, struct particles *p, size_t n);

/* Adds the particles of the voxels that were due last (STATE, and stress where it is known), for which there is room, and orders all
 * anew, those of which nothing is left as well. Waits. */
MUST_USE status particles_add(struct gpu *gpu, struct gpu_work *work, struct particles *p,
                              const struct rock *rock);

#endif
