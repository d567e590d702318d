/* Arenite's state, between its frame (arenite.c) and how that state begins and lasts (arenite_state.c). */
#ifndef HOODOO_ARENITE_H
#define HOODOO_ARENITE_H

#include "blocks/blocks.h"
#include "deposit/deposit.h"
#include "erosion/erosion.h"
#include "geology/maps.h"
#include "groundwater/groundwater.h"
#include "model/collapse.h"
#include "model/type.h"
#include "piles/piles.h"
#include "scene/source.h"
#include "skin/skin.h"
#include "stress/elastic.h"
#include "water/water.h"
#include "wind/wind.h"

/* What its processes and solvers have on the device, a row each: PART(name, lasts, bytes, create).
 *   name    struct arenite has a member `struct name name`, which name_destroy() frees, finished or not
 *   lasts   LASTS_RUN: from the start on; LASTS_JOB: from the first rock on, and it is made anew where edits change the job;
 *           LASTS_ROCK: as long as the particles, which edits may replace
 *   bytes   of a job with room for n particles, of a rock that would have `all`, `bare` of them at the surface and `ends` at the
 *           ends of rows along x, in so many voxels, its edits included; 0: it has no need of it
 *   create  makes it in *a, for a->m.job; OK: that has no need of it, or it is made when it is first used
 */
#define ARENITE_PARTS(PART)                                                                                  \
    PART(maps, LASTS_RUN, maps_bytes(job, voxels), maps_create(a->m.gpu, a->m.whole, a->m.voxels, &a->maps)) \
    PART(elastic, LASTS_RUN, arenite_ever(job, arenite_rests) ? elastic_bytes(voxels, all, bare, ends) : 0,  \
         elastic_create(a->m.gpu, a->m.voxels, a->m.h,                                                       \
                        (const struct elastic_options[]){elastic_options(a->m.job, a->maps.stiff)},          \
                        &a->elastic))                                                                        \
    PART(blocks, LASTS_ROCK, blocks_bytes(n),                                                                \
         blocks_create(a->m.gpu, a->particles.held.n, a->maps.parted, &a->blocks))                           \
    PART(wind, LASTS_RUN, wind_bytes(job, voxels), wind_create(a->m.gpu, a->m.whole, a->m.voxels, &a->wind)) \
    PART(deposit, LASTS_JOB, arenite_ever(job, deposit_wanted) ? deposit_bytes(voxels) : 0,                  \
         a->deposits ? deposit_create(a->m.gpu, a->m.voxels, &a->deposit) : OK)                              \
    PART(water, LASTS_JOB, arenite_ever(job, water_ever_flows) ? water_bytes(voxels, 1) : 0,                 \
         water_ever_flows(a->m.job) ? water_create(a->m.gpu, a->m.job, a->m.voxels, a->m.h, 1, &a->water)    \
                                    : OK)                                                                    \
    PART(fragments, LASTS_JOB, arenite_ever(job, deposit_wanted) ? water_bytes(voxels, 2) : 0,               \
         a->deposits ? fragments_create(a->m.gpu, a->m.job, a->m.voxels, a->m.h, &a->fragments) : OK)        \
    PART(groundwater, LASTS_JOB, groundwater_bytes(job, voxels),                                             \
         groundwater_create(a->m.gpu, a->m.job, a->m.voxels, &a->groundwater))                               \
    PART(erosion, LASTS_ROCK, erosion_bytes(n),                                                              \
         erosion_create(a->m.gpu, a->m.job, a->particles.n_max, &a->erosion))                                \
    PART(skin, LASTS_ROCK, job_keeps_exposed(job) ? skin_bytes(n) : 0,                                       \
         a->exposed ? skin_create(a->m.gpu, a->particles.n_max, &a->skin) : OK)                              \
    PART(collapse, LASTS_ROCK, collapse_bytes(job, n, voxels),                                               \
         collapse_create(a->m.gpu, a->m.job, &a->particles, &a->collapse))                                   \
    PART(mpm, LASTS_ROCK,                                                                                    \
         job->stress.solver == STRESS_MPM ? mpm_bytes(n, voxels, job->domain.spacing_m, 0) : 0, OK)

enum lasts { LASTS_RUN, LASTS_JOB, LASTS_ROCK };

struct arenite {
    struct model m; /* shared by all models */
    struct particles particles;
    struct scene_source *source; /* of the rock that has no particles yet; NULL: all has */
#define PART(name, lasts, bytes, create) struct name name;
    ARENITE_PARTS(PART)
#undef PART
    double
        beyond; /* m3 that steps would have taken farther in than they may, and nobody has been told of yet */
    bool deposits, plants; /* does the run ever have any? */
    bool exposed;          /* does its rock keep how long it has been bare? */
    bool seeps;            /* does the run ever have groundwater? */
    struct pile_tile tile; /* of rocks to show on deposits */
};

static inline struct arenite *arenite_of(struct model *m)
{
    return (struct arenite *)m;
}

/* ---- stages of a frame */

/* What the particles are now: rock, deposits, blocks on their way. Waits. */
MUST_USE status arenite_count(struct arenite *a);

/* Takes out, or lets fall, what no path joins to the ground. Waits. */
MUST_USE status arenite_unsupported(struct arenite *a);

/* What follows from the shape: surface, normals, stress, erodibility. `solved`: the displacement is this shape's
 * already. Rock in motion has its stress. Waits. */
MUST_USE status arenite_settle(struct arenite *a, bool solved);

/* All faces have been bare for as long as the job says when it begins. Waits. */
MUST_USE status arenite_age_before(struct arenite *a);

/* ---- its state */

/* What depends on the number of particles. */
MUST_USE status arenite_create_particles(struct arenite *a, const struct rock *rock);
void arenite_destroy_particles(struct arenite *a);

/* The parts that last so long, but for those of rock: the two above have them. */
MUST_USE status arenite_create_parts(struct arenite *a, enum lasts lasts);
void arenite_destroy_parts(struct arenite *a, enum lasts lasts);

/* Does the stress grid find its stress? Rock in motion has its own, and so do material points at rest. */
bool arenite_rests(const struct job *job);

/* Does the job want that, now or once edited? */
bool arenite_ever(const struct job *job, bool (*wanted)(const struct job *));

/* struct model_type's. */
MUST_USE status arenite_estimate(const struct job *job, struct model_needs *needs);
size_t arenite_work_items(const struct job *job, const int voxels[3]);
MUST_USE status arenite_create(struct model *m);
MUST_USE status arenite_begin(struct model *m);
MUST_USE status arenite_restore(struct model *m, const struct checkpoint *from);
MUST_USE status arenite_save(struct model *m, struct checkpoint *out);

void arenite_watch(const struct model *m, struct watch_list *list);
void arenite_destroy(struct model *m);

/* Which values frames have (HAS_* of values.h) with these. The wind adds its own. */
unsigned arenite_has(const struct job *job, bool water, bool plants, bool deposits, bool exposed);

#endif
