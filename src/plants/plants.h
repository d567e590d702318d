/* Plants: cover painted at the start, that holds the ground, shields it, grows and dies (Arenite 8.3, fig. 11).
 *
 * Cover c, 0 to 1, is a field of the particles and goes with them when they erode.
 * Shield     Wind and rain on a particle are times 1 - shelter c, its erodibility times 1 - binding c.
 * Growth     On deposits, where plants can stand: c' = growth c (1 - c), and bare ground takes seedlings from
 *            covered ground beside it, so that cover advances by spread_m_per_kyr whatever the spacing. On rock,
 *            painted cover stays as it is and gives no other rock any.
 * Death      c' = -death c on ground steeper than steepest_deg, where anything is overhead, and inside.
 * Nothing is run for a job that paints no plants.
 */
#ifndef HOODOO_PLANTS_H
#define HOODOO_PLANTS_H

#include <stdbool.h>

#include "gpu/gpu.h"
#include "job/job.h"
#include "particles/particles.h"

/* Does the job paint any? */
bool plants_wanted(const struct job *job);

/* Takes from intensity (float [n_surface], in the order of p->surface) what plants keep off. Records only. */
void plants_shield(struct gpu *gpu, const struct job *job, struct particles *p, struct gpu_buffer *intensity);

/* Takes from the surface's erodibility what roots hold, once, after erosion_interlock(). Records only. */
void plants_bind(struct gpu *gpu, const struct job *job, struct particles *p);

/* The years of a frame pass for the plants. Needs surface and normals of the current shape; uses the particles'
 * spare words. Records only. */
void plants_grow(struct gpu *gpu, const struct job *job, int frame, struct particles *p);

#endif
