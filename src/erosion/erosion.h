/* How rock weathers: interlocking under stress, and the viability that wind and water take (Arenite eqs. 1,
 * 2). */
#ifndef HOODOO_EROSION_H
#define HOODOO_EROSION_H

#include "erosion/budget.h"
#include "gpu/gpu.h"
#include "gpu/primitives.h"
#include "job/job.h"
#include "particles/particles.h"

struct erosion {
    /* float [n_max]: wind and water on each particle of the surface, in the order of particles.surface; the
     * processes fill it before erosion_weather(). */
    struct gpu_buffer *intensity;
    struct gpu_buffer
        *parts; /* uint [n_max], likewise: deflation's and water's share in it (erosion/parts.glsl) */
    struct gpu_buffer *layers; /* vec4 [2 n_layers], of this frame: weak, strong (m/kyr), I (Pa), 0; and the
                                * layer's own k_d, k_a, k_t (1/Pa), tau_c (Pa), negative where they are the job's */
    size_t n_layers;
};

uint64_t erosion_bytes(size_t n);
MUST_USE status erosion_create(struct gpu *gpu, const struct job *job, size_t n_max, struct erosion *out);
void erosion_destroy(struct gpu *gpu, struct erosion *e);

/* Steps a frame is cut into, so that none takes more than erosion.max_step of a particle of rock that retreats so fast. In each of
 * them stress is solved at least once. */
int erosion_steps(const struct job *job, double m_per_kyr);

/* Particles' `erodibility` from their stress, with the strata as they are in this frame. Waits. */
MUST_USE status erosion_interlock(struct gpu *gpu, struct erosion *e, const struct job *job, int frame,
                                  struct particles *p);

/* Intensities, which are what faces across the beds have, grow where the surface looks along them, by what `along` has
 * (geology/maps.h). Records only. */
void erosion_lead(struct gpu *gpu, struct erosion *e, const struct job *job, struct gpu_buffer *along,
                  struct particles *p);

/* Frost and heat: intensities of rock grow and fall by the aspect of its surface and its height (job->aspect). Records only.
 *
 * f = rate^(a / 2) rate_per_100m^(z / 100 m), a being the normal's part along the azimuth. The form is chosen; that slopes in the shade,
 * which stay moist and freeze, weather otherwise than those in the sun is in Burnett, Meyer and McFadden, J. Geophys. Res. 113, 2008, and
 * that frost cracks rock at heights where it is cold for long in Hales and Roering, J. Geophys. Res. 112, 2007. */
bool erosion_has_aspect(const struct job *job);
void erosion_aspect(struct gpu *gpu, struct erosion *e, const struct job *job, struct particles *p);

/* The retreat of the fastest spots of the surface, m/kyr: of rock, and of deposits where water takes them. And how fast water's
 * slopes change, 1/kyr: in a longer step than its inverse floors pass by those below them, and swing. */
struct erosion_pace {
    double rock, loose, slopes;
};

/* The pace under e->intensity and the surface's `slopes`, which water_erode() fills. Waits. */
MUST_USE status erosion_pace(struct gpu *gpu, struct gpu_work *work, struct erosion *e, struct particles *p,
                             struct gpu_buffer *slopes, struct erosion_pace *out);

/* One step (`crust`: skin's, NULL: rock does not keep how long it has been bare): the surface's viability falls by e->intensity times erodibility, and so does that of what is bared meanwhile, for
 * the rest of the step, rock down to NEAR_REACH layers below: what it would have taken of rock farther in is added to *beyond,
 * m3. Those with none left are counted, not yet removed; their viability is 0, less what the step would still have taken of them. *budget has
 * what each process took. Needs surface and erodibility of the current shape; the intensity is lost. Waits. */
MUST_USE status erosion_weather(struct gpu *gpu, struct gpu_work *work, struct erosion *e, double kyr,
                                struct particles *p, struct gpu_buffer *crust, struct budget *budget,
                                uint32_t *n_eroded, double *beyond);

#endif
