/* The state of arenite, shared by its frame (arenite.c), its start and checkpoints (arenite_state.c), its estimate (arenite_needs.c) and
 * its rock without particles (arenite_deep.c). */
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

/* The data of processes and solvers on the device, one row each: PART(name, lasts, bytes, create).
 *   name    struct arenite gets a member `struct name name`, which name_destroy() frees, also if it was created only in part
 *   lasts   LASTS_RUN: for the whole run. LASTS_JOB: from the first rock on; recreated when edits change the job. LASTS_ROCK: as long
 *           as the particles, which edits may replace
 *   bytes   estimate for a job (with its edits) with capacity for n particles, whose rock would have `all` particles, `bare` at the
 *           surface and `ends` at ends of rows along x, in a domain of `voxels`; 0 if the job does not need it
 *   create  creates it in *a for a->m.job; OK if the job does not need it, or if it is created when first used
 */
#define ARENITE_PARTS(PART)                                                                                  \
    PART(maps, LASTS_RUN, maps_bytes(job, voxels), maps_create(a->m.gpu, a->m.whole, a->m.voxels, &a->maps)) \
    PART(elastic, LASTS_RUN,                                                                                 \
         edits_ever(job, arenite_uses_stress_grid) ? elastic_bytes(voxels, all, bare, ends) : 0,             \
         elastic_create(a->m.gpu, a->m.voxels, a->m.h,                                                       \
                        (const struct elastic_options[]){elastic_options(a->m.job, a->maps.stiff)},          \
                        &a->elastic))                                                                        \
    PART(blocks, LASTS_ROCK, blocks_bytes(n),                                                                \
         blocks_create(a->m.gpu, a->particles.held.n, a->maps.parted, &a->blocks))                           \
    PART(wind, LASTS_RUN, wind_bytes(job, voxels), wind_create(a->m.gpu, a->m.whole, a->m.voxels, &a->wind)) \
    PART(deposit, LASTS_JOB, edits_ever(job, deposit_wanted) ? deposit_bytes(voxels) : 0,                    \
         a->deposits ? deposit_create(a->m.gpu, a->m.voxels, &a->deposit) : OK)                              \
    PART(water, LASTS_JOB, edits_ever(job, water_ever_flows) ? water_bytes(voxels, 1) : 0,                   \
         water_ever_flows(a->m.job) ? water_create(a->m.gpu, a->m.job, a->m.voxels, a->m.h, 1, &a->water)    \
                                    : OK)                                                                    \
    PART(fragments, LASTS_JOB, edits_ever(job, deposit_wanted) ? water_bytes(voxels, 2) : 0,                 \
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
    struct scene_source *source; /* makes particles of deep rock; NULL if all rock has particles */
#define PART(name, lasts, bytes, create) struct name name;
    ARENITE_PARTS(PART)
#undef PART
    double beyond;         /* m3 that steps should have eroded but could not reach; not reported yet */
    bool deposits, plants; /* the run may have them */
    bool exposed;          /* particles store for how long they have been exposed */
    bool seeps;            /* the run may have groundwater */
    struct pile_tile tile; /* of rocks shown on deposits */
};

static inline struct arenite *arenite_of(struct model *m)
{
    return (struct arenite *)m;
}

/* ---- stages of a frame */

/* Counts the particles into the ledger: rock, deposits, falling blocks. Waits. */
MUST_USE status arenite_count(struct arenite *a);

/* Removes blocks that no path of rock joins to the ground, or lets them fall. Waits. */
MUST_USE status arenite_remove_unsupported(struct arenite *a);

/* Updates the quantities derived from the shape: surface, normals, stress, erodibility. `solved`: the displacement is the solution for this
 * shape already. In shots the stress is that of the material points. Waits. */
MUST_USE status arenite_update_derived(struct arenite *a, bool solved);

/* Sets the time for which all faces have been exposed at the start, as the job gives it. Waits. */
MUST_USE status arenite_set_start_age(struct arenite *a);

/* ---- its state */

/* Create and destroy the particles and the parts with LASTS_ROCK. */
MUST_USE status arenite_create_particles(struct arenite *a, const struct rock *rock);
void arenite_destroy_particles(struct arenite *a);

/* Create and destroy the parts with that lifetime (for LASTS_ROCK use the two above). */
MUST_USE status arenite_create_parts(struct arenite *a, enum lasts lasts);
void arenite_destroy_parts(struct arenite *a, enum lasts lasts);

/* Whether stress is computed on the stress grid. Shots and the mpm stress solver compute it with material points. */
bool arenite_uses_stress_grid(const struct job *job);

/* The functions of struct model_type. */
MUST_USE status arenite_estimate(const struct job *job, struct model_needs *needs);
size_t arenite_work_items(const struct job *job, const int voxels[3]);
MUST_USE status arenite_create(struct model *m);
MUST_USE status arenite_begin(struct model *m);
MUST_USE status arenite_restore(struct model *m, const struct checkpoint *from);
MUST_USE status arenite_save(struct model *m, struct checkpoint *out);
MUST_USE status arenite_resample(struct resampling *r);

/* The STATE fields of a checkpoint, borrowed from it and not to be freed, checked against the ledger of `m`, of which only jobs, voxels,
 * h and ledger are read. n_deep: arenite_deep_count(). *ids receives the particles' ids. E_CHECKPOINT. */
MUST_USE status arenite_read_rock(const struct model *m, const struct checkpoint *c, struct rock *rock,
                                  size_t n_deep, struct idset *ids);

void arenite_watch(const struct model *m, struct watch_list *list);
void arenite_destroy(struct model *m);

/* The values that frames have (HAS_* of values.h), with these processes. The wind's is added separately. */
unsigned arenite_has(const struct job *job, bool water, bool plants, bool deposits, bool exposed);

#endif
