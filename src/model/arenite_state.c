/* How arenite's state begins, and what lasts of it in checkpoints. */
#include "model/arenite.h"

#include <math.h>
#include <string.h>

#include "frame/rocks.h"
#include "model/air.h"
#include "model/edits.h"
#include "model/sections.h"
#include "plants/plants.h"
#include "scene/scene.h"

status arenite_create_particles(struct arenite *a, const struct rock *rock)
{
    status st = OK;
    TRY(particles_create(a->m.gpu, a->m.work, rock, STATE, a->m.voxels, a->m.h, &a->particles));
    TRY(erosion_create(a->m.gpu, a->m.job, a->particles.n_max, &a->erosion));
    TRY(collapse_create(a->m.gpu, a->m.job, &a->particles, &a->collapse));
    a->blocks.rubble |= a->collapse.falls;
    for (size_t i = 0; i < rock->n && !a->blocks.rubble; i++)
        a->blocks.rubble = rock->phase[i] == PHASE_FALLING;
done:
    return st;
}

void arenite_destroy_particles(struct arenite *a)
{
    mpm_destroy(a->m.gpu, &a->mpm);
    collapse_destroy(a->m.gpu, &a->collapse);
    erosion_destroy(a->m.gpu, &a->erosion);
    particles_destroy(a->m.gpu, &a->particles);
}

status arenite_create_water(struct arenite *a)
{
    status st = OK;
    if (arenite_routes(a->m.job))
        TRY(water_create(a->m.gpu, a->m.job, a->m.voxels, a->m.h, &a->water));
done:
    return st;
}

/* ---- checkpoints */

/* What the displacement depends on beside the rock's shape. */
enum { ELASTICITY = 4 };

static void elasticity(const struct arenite *a, double out[ELASTICITY])
{
    const struct elastic_options *e = &a->elastic.options;
    const double numbers[ELASTICITY] = {e->lambda, e->mu, e->density, e->gravity};
    memcpy(out, numbers, sizeof numbers);
}

status arenite_save(struct model *m, struct checkpoint *out)
{
    status st = OK;
    struct arenite *a = arenite_of(m);
    void *data;
    size_t n = a->particles.n, nodes = elastic_nodes(&a->elastic);
    for (int f = 0; f < ROCK_FIELDS; f++) {
        if (rock_field_table[f].keep != STATE)
            continue;
        /* Shuffled by float, whatever the field's width. */
        TRY(section_add(out, rock_field_table[f].name, 4, n * (size_t)rock_field_table[f].components, &data));
        TRY(gpu_download(a->m.gpu, a->particles.field[f], 0, data, n));
    }
    TRY(section_add(out, "displacement", 4, 4 * nodes, &data));
    TRY(gpu_download(a->m.gpu, a->elastic.u, 0, data, nodes));
    TRY(sections_add_counts(out, m));
    TRY(section_add(out, "iterations", 4, 1, &data));
    memcpy(data, &a->elastic.iterations, 4);
    TRY(section_add(out, "elasticity", 8, ELASTICITY, &data));
    elasticity(a, data);
    TRY(section_add(out, "processes", 8, 2, &data));
    memcpy(data, (const double[]){a->deposits, a->plants}, 2 * sizeof(double));
    if (a->wind.flows)
        TRY(air_save(a->m.gpu, &a->wind, out));
    if (a->collapse.shot)
        TRY(collapse_save(a->m.gpu, &a->collapse, out));
done:
    return st;
}

/* All that water, deposits and stress of the first frame need beside its rock. */
static status arrive(struct arenite *a, bool solved)
{
    status st = OK;
    if (a->deposits)
        TRY(deposit_create(a->m.gpu, a->m.voxels, &a->deposit));
    TRY(arenite_create_water(a));
    TRY(arenite_settle(a, solved));
done:
    return st;
}

/* The STATE fields, borrowed from the checkpoint: they are not to be freed. */
static status restore_rock(const struct checkpoint *c, struct rock *rock)
{
    status st = OK;
    const struct checkpoint_section *s;
    TRY(section_find(c, "id", 4, 0, &s));
    rock->n = s->n;
    for (int f = 0; f < ROCK_FIELDS; f++) {
        const struct rock_field_info *info = &rock_field_table[f];
        if (info->keep != STATE)
            continue;
        TRY(section_find(c, info->name, 4, rock->n * (size_t)info->components, &s));
        rock->field[f] = s->data;
    }
done:
    return st;
}

/* The displacement is a solution unless a branch has changed what it depends on. */
static status restore_stress(struct arenite *a, const struct checkpoint *c, bool *solved)
{
    status st = OK;
    const struct checkpoint_section *s;
    const size_t nodes = elastic_nodes(&a->elastic);
    double now[ELASTICITY];
    elasticity(a, now);
    TRY(section_find(c, "elasticity", 8, ELASTICITY, &s));
    *solved = memcmp(s->data, now, sizeof now) == 0;
    TRY(section_find(c, "iterations", 4, 1, &s));
    memcpy(&a->elastic.iterations, s->data, 4);
    TRY(section_find(c, "displacement", 4, 4 * nodes, &s));
    TRY(gpu_upload(a->m.gpu, a->elastic.u, 0, s->data, nodes));
done:
    return st;
}

status arenite_restore(struct model *m, const struct checkpoint *c)
{
    status st = OK;
    struct arenite *a = arenite_of(m);
    struct rock rock = {0};
    const struct checkpoint_section *s;
    bool solved;
    TRY(restore_rock(c, &rock));
    TRY(restore_stress(a, c, &solved));
    TRY(section_find(c, "processes", 8, 2, &s));
    a->deposits |= ((const double *)s->data)[0] != 0;
    a->plants |= ((const double *)s->data)[1] != 0;
    if (a->wind.flows)
        TRY(air_restore(m->gpu, &a->wind, c));
    TRY(arenite_create_particles(a, &rock));
    /* A shot may begin where years have passed. */
    if (a->collapse.shot && checkpoint_find(c, mpm_word_names[MPM_ID], 4))
        TRY(collapse_restore(m->gpu, &a->collapse, &a->particles, c));
    else if (a->collapse.shot)
        TRY(collapse_load(m->gpu, &a->collapse, &a->particles));
    TRY(arrive(a, solved));
done:
    return st;
}

/* ---- the first frame */

status arenite_begin(struct model *m)
{
    status st = OK;
    struct arenite *a = arenite_of(m);
    struct rock rock = {0};
    TRY(scene_sample(m->whole, &rock));
    m->ledger = (struct ledger){.start = rock.n, .rock = rock.n};
    TRY(edits_apply(m->whole, m->frame, &rock, &m->ledger, &m->start_volume));
    for (size_t i = 0; i < rock.n && !a->deposits; i++)
        a->deposits = rock.phase[i] == PHASE_DEPOSIT; /* a scene of stacks has loose ground */
    TRY(arenite_create_particles(a, &rock));
    TRY(arenite_count(a));
    if (a->collapse.shot)
        TRY(collapse_load(m->gpu, &a->collapse, &a->particles));
    else
        TRY(arenite_unsupported(a));
    if (!a->blocks.rubble)
        model_warn_unheld(m, "particles");
    rock_free(&rock);
    TRY(particles_download(m->gpu, &a->particles, STATE, &rock));
    m->start_volume = model_sum(rock.viability, rock.n) * pow(m->h, 3);
    TRY(arrive(a, false));
done:
    rock_free(&rock);
    return st;
}

status arenite_create(struct model *m)
{
    status st = OK;
    struct arenite *a = arenite_of(m);
    const struct elastic_options options = elastic_options(m->job);
    a->plants = plants_wanted(m->whole) || edits_plant(m->whole);
    a->deposits = arenite_ever(m->whole, deposit_wanted);
    TRY(elastic_create(m->gpu, m->voxels, m->h, &options, &a->elastic));
    TRY(blocks_create(m->gpu, m->voxels, &a->blocks));
    TRY(wind_create(m->gpu, m->whole, m->voxels, &a->wind));
    TRY(rocks_tile(m->whole, &a->tile));
    TRY(scene_edits_check(m->whole, m->frame));
done:
    return st;
}

void arenite_destroy(struct model *m)
{
    struct arenite *a = arenite_of(m);
    deposit_destroy(m->gpu, &a->deposit);
    blocks_destroy(m->gpu, &a->blocks);
    wind_destroy(m->gpu, &a->wind);
    water_destroy(m->gpu, &a->water);
    elastic_destroy(m->gpu, &a->elastic);
    arenite_destroy_particles(a);
    pile_tile_destroy(&a->tile);
}
