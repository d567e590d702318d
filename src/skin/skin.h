/* What becomes of rock where it meets the air: how long it has been bare, the crust that grows on it (case hardening), and the
 * damp of hollows, in which none does. README.md in this folder has the laws.
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

struct skin {
    /* float [n_max], by particle, of bare rock: what crust and damp multiply its rate with, and how damp it is, 0 to 1 */
    struct gpu_buffer *crust, *damp;
};

uint64_t skin_bytes(size_t n);
MUST_USE status skin_create(struct gpu *gpu, size_t n_max, struct skin *out);
void skin_destroy(struct gpu *gpu, struct skin *s);

/* All particles below keep exposed_kyr. All of these record only. */

/* Bare rock has the age that the job begins with. Needs the surface. */
void skin_begin(struct gpu *gpu, const struct job *job, struct particles *p);

/* What has become bare since the last time has its age, and the erodibility of bare rock is that under its crust, or in the damp. Once,
 * after all else that makes erodibility; uses the particles' spare words. Needs the surface and its normals. */
void skin_find(struct gpu *gpu, struct skin *s, const struct job *job, struct particles *p);

/* A step of so many kyr passes for the surface, under intensity (float [n_surface], in the order of p->surface) and erodibility,
 * before it is taken from the viability. Intensities become less by what crusts grow until the middle of the step. */
void skin_age(struct gpu *gpu, const struct skin *s, const struct job *job, double kyr,
              struct gpu_buffer *intensity, struct particles *p);

/* What has no viability left is not bare any more, and begins anew if it comes to rest. */
void skin_forget(struct gpu *gpu, struct particles *p);

#endif
