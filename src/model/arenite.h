/* Arenite's state, between its frame (arenite.c) and how that state begins and lasts (arenite_state.c). */
#ifndef HOODOO_ARENITE_H
#define HOODOO_ARENITE_H

#include "blocks/blocks.h"
#include "deposit/deposit.h"
#include "erosion/erosion.h"
#include "model/collapse.h"
#include "model/type.h"
#include "piles/piles.h"
#include "stress/elastic.h"
#include "water/water.h"
#include "wind/wind.h"

struct arenite {
    struct model m; /* shared by all models */
    struct particles particles;
    struct elastic elastic;
    struct mpm mpm; /* stress.solver: mpm */
    struct collapse collapse;
    struct erosion erosion;
    struct wind wind;
    struct water water;
    bool told; /* that water is held back */
    struct deposit deposit;
    struct blocks blocks;
    bool deposits, plants; /* does the run ever have any? */
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

/* ---- its state */

/* What depends on the number of particles. */
MUST_USE status arenite_create_particles(struct arenite *a, const struct rock *rock);
void arenite_destroy_particles(struct arenite *a);

/* For the job as it is now. */
MUST_USE status arenite_create_water(struct arenite *a);

/* Does anything in the job need to know where water runs? */
bool arenite_routes(const struct job *job);

/* Does the job want that, now or once edited? */
bool arenite_ever(const struct job *job, bool (*wanted)(const struct job *));

/* struct model_type's. */
MUST_USE status arenite_estimate(const struct job *job, struct model_needs *needs);
size_t arenite_work_items(const struct job *job, const int voxels[3]);
MUST_USE status arenite_create(struct model *m);
MUST_USE status arenite_begin(struct model *m);
MUST_USE status arenite_restore(struct model *m, const struct checkpoint *from);
MUST_USE status arenite_save(struct model *m, struct checkpoint *out);
void arenite_destroy(struct model *m);

/* Which values frames have (HAS_* of values.h) with these. The wind adds its own. */
unsigned arenite_has(bool water, bool plants, bool deposits);

#endif
