/* What becomes of rock where it meets the air: how long it has been bare. README.md in this folder has the law.
 *
 * The age A of a particle, its field exposed_kyr, is that of its outermost point. On a face it grows with time and is worn off with
 * what wears off; what is bared takes over from what went off it, and from faces near it. Inside it stays as it is: what has been
 * buried goes on where it was. What has come to rest as a deposit begins anew.
 */
#ifndef HOODOO_SKIN_H
#define HOODOO_SKIN_H

#include "gpu/gpu.h"
#include "job/job.h"
#include "particles/particles.h"

/* All particles below keep exposed_kyr. All of these record only. */

/* Bare rock has the age that the job begins with. Needs the surface. */
void skin_begin(struct gpu *gpu, const struct job *job, struct particles *p);

/* What has become bare since the last time has its age; uses the particles' spare words. Needs the surface and its normals. */
void skin_find(struct gpu *gpu, const struct job *job, struct particles *p);

/* A step of so many kyr passes for the surface, under intensity (float [n_surface], in the order of p->surface) and erodibility,
 * before it is taken from the viability. */
void skin_age(struct gpu *gpu, const struct job *job, double kyr, struct gpu_buffer *intensity,
              struct particles *p);

/* What has no viability left is not bare any more, and begins anew if it comes to rest. */
void skin_forget(struct gpu *gpu, struct particles *p);

#endif
