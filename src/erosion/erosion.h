/* Erosion of the surface: erodibility under stress, and the viability that wind and water remove (Arenite eqs. 1 and 2).
 * README.md has the equations. */
#ifndef HOODOO_EROSION_H
#define HOODOO_EROSION_H

#include "erosion/budget.h"
#include "gpu/gpu.h"
#include "gpu/primitives.h"
#include "job/job.h"
#include "particles/particles.h"

struct erosion {
    /* float [n_max]: W + F on each surface particle, in the order of particles.surface. The processes fill it before
     * erosion_weather(). 1 makes bare, unstressed rock retreat at its weak rate. */
    struct gpu_buffer *intensity;
    struct gpu_buffer *parts; /* uint [n_max], same order: the processes' shares in it (erosion/parts.glsl) */
    struct gpu_buffer
        *layers; /* vec4 [2 n_layers], values of this frame: weak, strong (m/kyr), I (Pa), 0; and the layer's
                                * own k_d, k_a, k_t (1/Pa), tau_c (Pa), negative where the job's value holds */
    size_t n_layers;
};

uint64_t erosion_bytes(size_t n);
MUST_USE status erosion_create(struct gpu *gpu, const struct job *job, size_t n_max, struct erosion *out);
void erosion_destroy(struct gpu *gpu, struct erosion *e);

/* Number of steps for a frame, 1 to 1000: rock that retreats at m_per_kyr loses at most erosion.max_step of a particle in
 * each. Stress is solved at least once per step. */
int erosion_steps(const struct job *job, double m_per_kyr);

/* Computes the particles' `erodibility` (m/kyr) from their `stress`, with the strata's values of this frame. Uploads the
 * layers; waits for the device. */
MUST_USE status erosion_interlock(struct gpu *gpu, struct erosion *e, const struct job *job, int frame,
                                  struct particles *p);

/* Raises intensities where the surface cuts thin beds steeply enough for the soft ones to lead, by the factor `along`
 * (geology/maps.h). Records only. */
void erosion_lead(struct gpu *gpu, struct erosion *e, const struct job *job, struct gpu_buffer *along,
                  struct particles *p);

/* Frost and heat: multiplies intensities of rock by a factor of the surface's aspect and height (job->aspect),
 *
 *   f = rate^(a / 2) rate_per_100m^(z / 100 m)        a: component of the normal along the azimuth.
 *
 * The form is our choice. Shaded slopes stay moist, freeze, and weather differently from sunny ones (Burnett, Meyer and
 * McFadden, J. Geophys. Res. 113, 2008); frost cracks rock at heights where it is cold for long (Hales and Roering,
 * J. Geophys. Res. 112, 2007). Records only. */
bool erosion_has_aspect(const struct job *job);
void erosion_aspect(struct gpu *gpu, struct erosion *e, const struct job *job, struct particles *p);

/* Largest retreat on the surface, m/kyr: of rock, and of deposits by water. slopes: fastest change of water's slopes, 1/kyr; in
 * a step longer than its inverse a stream's floor would sink below the floor downstream and oscillate. */
struct erosion_pace {
    double rock, loose, slopes;
};

/* Computes the pace from e->intensity and `slopes` (float [n_surface], filled by water_erode()). Waits for the device. */
MUST_USE status erosion_pace(struct gpu *gpu, struct gpu_work *work, struct erosion *e, struct particles *p,
                             struct gpu_buffer *slopes, struct erosion_pace *out);

/* One time step of `kyr`: viability of the surface falls by erodibility times e->intensity; what is bared meanwhile erodes for
 * the rest of the step, down to NEAR_REACH layers of rock. The volume that the step would have eroded below these is added to
 * *beyond, m3. *n_eroded: particles whose viability is used up; they are not removed yet, and their viability is <= 0. *budget
 * receives each process's volume. `crust` is the skin's factor, or NULL if exposure is not tracked. Needs surface, normals and
 * erodibility of the current shape; overwrites e->intensity. Waits for the device. */
MUST_USE status erosion_weather(struct gpu *gpu, struct gpu_work *work, struct erosion *e, double kyr,
                                struct particles *p, struct gpu_buffer *crust, struct budget *budget,
                                uint32_t *n_eroded, double *beyond);

#endif
