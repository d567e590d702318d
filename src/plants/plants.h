/* Plants: cover painted at the start, which binds the ground, shields it, grows, spreads and dies (Arenite 8.3, fig. 11).
 * README.md has the laws.
 *
 * Cover c, 0 to 1, belongs to the surface: a field of its particles, 0 inside, which passes to what is bared when they erode
 * (erosion/carry) and partly grows through deposits that bury it (deposit/apply). A job that paints no plants runs nothing of this.
 */
#ifndef HOODOO_PLANTS_H
#define HOODOO_PLANTS_H

#include <stdbool.h>

#include "gpu/gpu.h"
#include "job/job.h"
#include "particles/particles.h"

/* Whether the job paints any vegetation. */
bool plants_wanted(const struct job *job);

/* Reduces intensity (float [n_surface], in the order of p->surface): times 1 - shelter c. Records only. */
void plants_shield(struct gpu *gpu, const struct job *job, struct particles *p, struct gpu_buffer *intensity);

/* Reduces the surface's erodibility, times 1 - binding c, and clears cover inside the rock. Call once after each
 * erosion_interlock(). Records only. */
void plants_bind(struct gpu *gpu, const struct job *job, struct particles *p);

/* Advances the plants by a frame: growth and death, seeds, spread. Needs surface and normals of the current shape; overwrites
 * p->place. Records only. */
void plants_grow(struct gpu *gpu, const struct job *job, int frame, struct particles *p);

#endif
