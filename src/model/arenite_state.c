/* How the state of arenite is created, saved and restored. */
#include "model/arenite.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "frame/rocks.h"
#include "model/air.h"
#include "model/arenite_deep.h"
#include "model/edits.h"
#include "model/sections.h"
#include "plants/plants.h"
#include "scene/scene.h"

status arenite_create_parts(struct arenite *a, enum lasts lasts)
{
    status st = OK;
#define PART(name, so_long, bytes, create)                                                                   \
    if (lasts == so_long)                                                                                    \
        TRY(create);
    ARENITE_PARTS(PART)
#undef PART
done:
    return st;
}

void arenite_destroy_parts(struct arenite *a, enum lasts lasts)
{
#define PART(name, so_long, bytes, create)                                                                   \
    if (lasts == so_long)                                                                                    \
        name##_destroy(a->m.gpu, &a->name);
    ARENITE_PARTS(PART)
#undef PART
}

status arenite_create_particles(struct arenite *a, const struct rock *rock)
{
    status st = OK;
    TRY(particles_create(a->m.gpu, a->m.work, rock, STATE, a->m.voxels, a->m.h, &a->particles));
    if (a->exposed)
        TRY(particles_keep(a->m.gpu, &a->particles, ROCK_exposed_kyr));
    if (a->seeps)
        TRY(particles_keep(a->m.gpu, &a->particles, ROCK_seepage));
    a->particles.walls = job_walls(a->m.job);
    TRY(arenite_create_parts(a, LASTS_ROCK));
    a->blocks.rubble |= a->collapse.falls;
    for (size_t i = 0; i < rock->n && !a->blocks.rubble; i++)
        a->blocks.rubble = rock->phase[i] == PHASE_FALLING;
    if (a->blocks.rubble || a->collapse.shot)
        TRY(particles_hold_around(a->m.gpu, a->m.work, &a->particles));
done:
    return st;
}

void arenite_destroy_particles(struct arenite *a)
{
    arenite_destroy_parts(a, LASTS_ROCK);
    particles_destroy(a->m.gpu, &a->particles);
}

/* ---- checkpoints */

/* What the displacement depends on besides the shape of the rock. */
enum { ELASTICITY = 5 };

static void elasticity(const struct arenite *a, double out[ELASTICITY])
{
    const struct elastic_options *e = &a->elastic.options;
    const double numbers[ELASTICITY] = {e->lambda, e->mu, e->density, e->gravity, e->walls};
    memcpy(out, numbers, sizeof numbers);
}

/* Four numbers for each node that can move. (Version 0.1.0 wrote the whole grid as `displacement`, which is not read.) */
static const char displacements[] = "displacements";

/* The stiffness of deposits, on which the displacement depends as well. (Version 0.1.0 did not have it; then the stress is solved again.) */
static const char loose_ground[] = "loose ground";

status arenite_save(struct model *m, struct checkpoint *out)
{
    status st = OK;
    struct arenite *a = arenite_of(m);
    void *data;
    const size_t n = a->particles.n;
    for (int f = 0; f < ROCK_FIELDS; f++) {
        if (rock_field_table[f].keep != STATE || !a->particles.field[f])
            continue;
        /* Always items of four bytes, so that the shuffle works on floats. */
        TRY(section_add(out, rock_field_table[f].name, 4, n * (size_t)rock_field_table[f].components, &data));
        TRY(gpu_download(a->m.gpu, a->particles.field[f], 0, data, n));
    }
    if (a->elastic.lattice.n_active) {
        TRY(section_add(out, displacements, 4, 4 * a->elastic.lattice.n_active, &data));
        TRY(elastic_download(a->m.gpu, &a->elastic, data));
    }
    TRY(arenite_save_deep(a, out));
    TRY(sections_add_counts(out, m));
    TRY(section_add(out, "iterations", 4, 1, &data));
    memcpy(data, &a->elastic.iterations, 4);
    TRY(section_add(out, "elasticity", 8, ELASTICITY, &data));
    elasticity(a, data);
    TRY(section_add(out, loose_ground, 8, 1, &data));
    memcpy(data, &a->elastic.options.loose, sizeof(double));
    TRY(section_add(out, "processes", 8, 2, &data));
    memcpy(data, (const double[]){a->deposits, a->plants}, 2 * sizeof(double));
    if (a->wind.flows)
        TRY(air_save(a->m.gpu, &a->wind, out));
    if (a->collapse.shot)
        TRY(collapse_save(a->m.gpu, &a->collapse, out));
done:
    return st;
}

/* Creates what the first frame needs besides its rock. */
static status prepare_first_frame(struct arenite *a, bool solved)
{
    status st = OK;
    TRY(arenite_create_parts(a, LASTS_JOB));
    TRY(arenite_update_derived(a, solved));
done:
    return st;
}

/* Sets the range of a field; fields that are not listed may have any finite number. */
static void set_range(const struct model *m, int f, struct section_rule *rule)
{
    static const double factor = 1e12; /* repeated painting multiplies factors */
    static const double known[ROCK_FIELDS][2] = {
        [ROCK_id] = {0, UINT32_MAX},           [ROCK_viability] = {0, 1},
        [ROCK_phase] = {0, PHASE_FALLING},     [ROCK_rate_factor] = {0, factor},
        [ROCK_interlock_factor] = {0, factor}, [ROCK_vegetation] = {0, 1},
        [ROCK_exposed_kyr] = {0, 1e12}};
    const double layers[2] = {0, (double)m->job->n_strata - 1},
                 finite[2] = {-(double)FLT_MAX, (double)FLT_MAX};
    const double *range = f == ROCK_layer ? layers : known[f][1] > 0 ? known[f] : finite;
    for (size_t a = 0; a < rule->stride; a++)
        memcpy(rule->range[a], range, sizeof finite);
    if (f == ROCK_P)
        section_place(rule->range, m->voxels, m->h);
}

/* Checks that the ledger counts the particles that exist, and that ids are below the number of particles that ever existed. */
static status check_rock(const struct model *m, const struct checkpoint *c, const struct rock *rock,
                         size_t n_deep, struct idset *ids)
{
    status st = OK;
    const struct ledger *l = &m->ledger;
    size_t falling = 0;
    for (size_t i = 0; i < rock->n; i++)
        falling += rock->phase[i] == PHASE_FALLING;
    if (l->rock + l->deposit + falling != rock->n + n_deep || l->fallen < falling)
        return fail(
            E_CHECKPOINT,
            "the checkpoint of frame %d is damaged: section 'ledger' counts %llu of rock, %llu deposited and %llu fallen, but there are %zu particles, %zu of them falling, and %zu voxels of rock without particles",
            c->frame, (unsigned long long)l->rock, (unsigned long long)l->deposit,
            (unsigned long long)l->fallen, rock->n, falling, n_deep);
    TRY(section_check_ids(c, "id", rock->id, rock->n, l->start, ids));
done:
    return st;
}

status arenite_read_rock(const struct model *m, const struct checkpoint *c, struct rock *rock, size_t n_deep,
                         struct idset *ids)
{
    status st = OK;
    const struct checkpoint_section *id = checkpoint_find(c, "id", 4);
    rock->n = id ? id->n : 0;
    for (int f = 0; f < ROCK_FIELDS; f++) {
        const struct rock_field_info *info = &rock_field_table[f];
        const size_t stride = (size_t)info->components;
        struct section_rule rule = {
            info->name, info->is_float ? SECTION_FLOAT : SECTION_WORD, stride * rock->n, stride, {{0}}};
        const void *data;
        /* A branch may start to store exposure although its run did not, or no longer store it. */
        if (info->keep != STATE ||
            (f == ROCK_exposed_kyr && (!job_keeps_exposed(m->whole) || !checkpoint_find(c, info->name, 4))))
            continue;
        set_range(m, f, &rule);
        TRY(section_get(c, &rule, &data, NULL));
        rock->field[f] = (void *)(uintptr_t)data;
    }
    TRY(check_rock(m, c, rock, n_deep, ids));
done:
    return st;
}

/* Larger numbers are damage. */
enum { MOST_ITERATIONS = 1000000000, MOST_MOVED = 1000000000 /* m */ };

/* Restores the displacements of the present shape. If the stress was computed otherwise, there are none, and it is solved from zero. */
static status restore_displacements(struct arenite *a, const struct checkpoint *c, bool *solved)
{
    status st = OK;
    const void *data;
    if (!arenite_uses_stress_grid(a->m.job))
        return OK;
    TRY(elastic_assemble(a->m.gpu, a->m.work, &a->elastic, &a->particles));
    const size_t n = a->elastic.lattice.n_active;
    const struct section_rule rule = {displacements, SECTION_FLOAT, 4 * n, 1, {{-MOST_MOVED, MOST_MOVED}}};
    *solved &= checkpoint_find(c, displacements, 4) != NULL;
    if (!checkpoint_find(c, displacements, 4))
        return OK;
    TRY(section_get(c, &rule, &data, NULL));
    TRY(elastic_upload(a->m.gpu, &a->elastic, data));
done:
    return st;
}

/* The restored displacement is the solution, unless a branch has changed what it depends on. */
static status restore_stress(struct arenite *a, const struct checkpoint *c, bool *solved)
{
    status st = OK;
    const struct section_rule constants = {"elasticity",
                                           SECTION_DOUBLE,
                                           ELASTICITY,
                                           1,
                                           {{0, SECTION_COUNT_MAX}}},
                              number = {"iterations", SECTION_WORD, 1, 1, {{0, MOST_ITERATIONS}}};
    const void *data;
    double now[ELASTICITY];
    elasticity(a, now);
    TRY(section_get(c, &constants, &data, NULL));
    *solved = memcmp(data, now, sizeof now) == 0 && checkpoint_find(c, loose_ground, 8) != NULL;
    if (*solved) {
        TRY(section_get(c, &(struct section_rule){loose_ground, SECTION_DOUBLE, 1, 1, {{0, 1}}}, &data,
                        NULL));
        *solved = memcmp(data, &a->elastic.options.loose, sizeof(double)) == 0;
    }
    TRY(section_get(c, &number, &data, NULL));
    memcpy(&a->elastic.iterations, data, 4);
    TRY(restore_displacements(a, c, solved));
done:
    return st;
}

status arenite_restore(struct model *m, const struct checkpoint *c)
{
    status st = OK;
    struct arenite *a = arenite_of(m);
    struct rock rock = {0};
    struct idset ids = {0};
    const void *data;
    bool solved;
    TRY(arenite_read_rock(m, c, &rock, arenite_deep_count(m->voxels, c), &ids));
    TRY(section_get(c, &(struct section_rule){"processes", SECTION_DOUBLE, 2, 1, {{0, 1}}}, &data, NULL));
    a->deposits |= ((const double *)data)[0] != 0;
    a->plants |= ((const double *)data)[1] != 0;
    if (a->wind.flows)
        TRY(air_restore(m->gpu, &a->wind, c));
    TRY(arenite_create_particles(a, &rock));
    TRY(arenite_restore_deep(a, c, &ids));
    TRY(restore_stress(a, c, &solved));
    /* If the checkpoint is not from a shot, a shot starts here. */
    if (a->collapse.shot && checkpoint_find(c, mpm_word_names[MPM_ID], 4))
        TRY(collapse_restore(m->gpu, &a->collapse, &a->particles, c, &ids));
    else if (a->collapse.shot)
        TRY(collapse_load(m->gpu, &a->collapse, &a->particles));
    TRY(prepare_first_frame(a, solved));
done:
    idset_free(&ids);
    return st;
}

/* ---- the first frame */

/* The foot of the lowest voxel that is at least half rock, m; HUGE_VAL: there is none. */
static double lowest_of(const struct model *m, const struct rock *rock, const uint32_t *deep)
{
    const size_t words = held_words(m->voxels);
    double lowest = HUGE_VAL;
    for (size_t i = 0; i < rock->n; i++)
        if (rock->viability[i] >= 0.5f)
            lowest = fmin(lowest, floor((double)rock->P[4 * i + 2] / m->h) * m->h);
    for (size_t w = 0; deep && w < words; w++)
        if (deep[w])
            return fmin(lowest, (double)(w / (words / (size_t)m->voxels[2])) * m->h);
    return lowest;
}

status arenite_begin(struct model *m)
{
    status st = OK;
    struct arenite *a = arenite_of(m);
    struct rock rock = {0};
    uint32_t *deep = NULL;
    size_t n_deep;
    TRY(arenite_first_rock(a, &rock, &deep, &n_deep));
    m->ledger = (struct ledger){.start = rock.n + n_deep, .rock = rock.n + n_deep};
    TRY(edits_apply(m->whole, m->frame, &rock, &m->ledger, &m->start_volume));
    for (size_t i = 0; i < rock.n && !a->deposits; i++)
        a->deposits = rock.phase[i] == PHASE_DEPOSIT; /* a scene of stacks has loose ground */
    TRY(arenite_create_particles(a, &rock));
    if (n_deep)
        TRY(particles_set_deep(m->gpu, m->work, &a->particles, deep, n_deep));
    TRY(arenite_add_due(a, DUE_NEAR, 0));
    TRY(arenite_count(a));
    if (a->collapse.shot)
        TRY(collapse_load(m->gpu, &a->collapse, &a->particles));
    else
        TRY(arenite_remove_unsupported(a));
    const double lowest = lowest_of(m, &rock, deep);
    rock_free(&rock);
    TRY(particles_download(m->gpu, &a->particles, STATE, &rock));
    if (!a->blocks.rubble)
        TRY(model_check_supported(m, lowest,
                                  a->particles.n_deep > 0 || lowest_of(m, &rock, NULL) < HUGE_VAL));
    if (a->exposed)
        TRY(arenite_set_start_age(a));
    m->start_volume = (model_sum(rock.viability, rock.n) + (double)a->particles.n_deep) * pow(m->h, 3);
    TRY(prepare_first_frame(a, false));
done:
    free(deep);
    rock_free(&rock);
    return st;
}

status arenite_create(struct model *m)
{
    status st = OK;
    struct arenite *a = arenite_of(m);
    m->shown = &a->particles;
    a->exposed = job_keeps_exposed(m->whole);
    a->seeps = job_seeps(m->whole);
    a->plants = plants_wanted(m->whole) || edits_plant(m->whole);
    a->deposits = edits_ever(m->whole, deposit_wanted);
    TRY(arenite_create_parts(a, LASTS_RUN));
    TRY(rocks_tile(m->whole, &a->tile));
    TRY(scene_edits_check(m->whole, m->frame));
done:
    return st;
}

void arenite_destroy(struct model *m)
{
    struct arenite *a = arenite_of(m);
    arenite_destroy_particles(a);
    arenite_destroy_parts(a, LASTS_JOB);
    arenite_destroy_parts(a, LASTS_RUN);
    pile_tile_destroy(&a->tile);
    scene_source_destroy(&a->source);
}
