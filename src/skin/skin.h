/* Rock exposed to air: exposure age, the crust that grows with it (case hardening), and the damp of hollows, where none grows.
 * README.md has the laws.
 *
 * A particle's age A, field exposed_kyr, is that of its outermost point. On a face it grows with time and falls with retreat. A
 * particle that is bared takes over the age of those eroded in front of it, and of faces near it. Inside the rock the age stays as it
 * is, so that what was buried continues where it was. What comes to rest as a deposit starts at 0.
 */
#ifndef HOODOO_SKIN_H
#define HOODOO_SKIN_H

#include "gpu/gpu.h"
#include "job/job.h"
#include "particles/particles.h"

struct skin {
    /* float [n_max], by particle, of bare rock: factor of crust and damp in its rate; damp, 0 to 1 */
    struct gpu_buffer *crust, *damp;
};

uint64_t skin_bytes(size_t n);
MUST_USE status skin_create(struct gpu *gpu, size_t n_max, struct skin *out);
void skin_destroy(struct gpu *gpu, struct skin *s);

/* The functions below need particles with the field exposed_kyr. They record only. */

/* Sets the age of bare rock in the first frame (skin.before_kyr). Needs the surface. */
void skin_begin(struct gpu *gpu, const struct job *job, struct particles *p);

/* Finds the age of what has become bare since the last call, and multiplies the erodibility of bare rock by the factor of crust and
 * damp. Call once, after everything else that determines erodibility. Overwrites p's scratch buffers. Needs surface and normals. */
void skin_find(struct gpu *gpu, struct skin *s, const struct job *job, struct particles *p);

/* Ages the surface by a step of `kyr` under intensity (float [n_surface], in the order of p->surface) and erodibility; call before
 * erosion_weather(). Reduces intensities by the growth of crusts until the middle of the step. */
void skin_age(struct gpu *gpu, const struct skin *s, const struct job *job, double kyr,
              struct gpu_buffer *intensity, struct particles *p);

/* Clears the age of particles whose viability is used up, so that they start at 0 if they come to rest. */
void skin_forget(struct gpu *gpu, struct particles *p);

#endif
