/* Plants: cover painted at the start, that holds the ground, shields it, grows and dies (Arenite 8.3, fig. 11).
 *
 * Cover c, 0 to 1, is the surface's: a field of its particles, 0 inside, that passes to what is bared when they erode
 * (erosion/carry), and in part through deposits that bury it, by their thickness (deposit/apply).
 * Shield     Wind and rain on a particle are times 1 - shelter c, its erodibility times 1 - binding c.
 * Growth     On deposits, where plants can stand: c' = growth c (1 - c), and bare ground takes seedlings from
 *            covered ground beside it, so that cover advances by spread_m_per_kyr whatever the spacing. On rock,
 *            painted cover stays as it is and gives no other rock any.
 * Seeds      The wind brings them to bare deposits from covered ground, exponentially distributed about seeds_m off, from all
 *            sides: seeds_per_m2_kyr take root where they come from full cover.
 * Death      c' = -death c on ground steeper than steepest_deg, over some metres, and where anything is overhead.
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

/* Takes from the surface's erodibility what roots hold, once, after erosion_interlock(); inside there are no plants. Records
 * only. */
void plants_bind(struct gpu *gpu, const struct job *job, struct particles *p);

/* The years of a frame pass for the plants. Needs surface and normals of the current shape; uses the particles'
 * spare words. Records only. */
void plants_grow(struct gpu *gpu, const struct job *job, int frame, struct particles *p);

#endif
