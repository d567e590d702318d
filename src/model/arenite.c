/* Arenite: sandstone as particles that weather where wind finds them and stress does not hold them (Yang et
 * al. 2025, algorithm 1).
 *
 * One frame, as DESIGN 3 lists it:
 *
 *   edits -> plants -> wind -> water -> viability -> eroded particles, deposits -> unsupported blocks
 *   -> surface, normals -> stress -> erodibility
 *
 * all but the first once or more, until the frame's years have passed; output() then adds the surface field and
 * the pictures.
 * The state between frames is the particles, the grid's displacement, the air and the ledger; the rest is
 * found anew from them, so that a resumed run has the same bits.
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/log.h"
#include "base/memory.h"
#include "blocks/blocks.h"
#include "deposit/deposit.h"
#include "erosion/budget.h"
#include "erosion/erosion.h"
#include "field/aov.h"
#include "field/field.h"
#include "frame/rocks.h"
#include "model/air.h"
#include "model/collapse.h"
#include "model/edits.h"
#include "model/model.h"
#include "model/sections.h"
#include "particles/particles.h"
#include "plants/plants.h"
#include "scene/scene.h"
#include "stress/elastic.h"
#include "water/water.h"
#include "wind/wind.h"

/* Spacings that a step may take where water is fast, before it is cut shorter: those the carry can still take
 * off whole. */
static const double WATER_STEP = 1.5;

struct model {
    struct gpu *gpu;
    const struct job *whole; /* as loaded */
    const struct job *job;   /* as the edits up to this frame have it */
    int frame;
    double years;        /* since the first frame */
    double start_volume; /* m3 */
    struct ledger ledger;
    struct budget budget;
    int64_t change[BUDGET_ROWS]; /* quanta, in the last frame */
    struct gpu_work *work;
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
    struct field field;
    struct aov aov;
};

static size_t voxel_count(const int voxels[3])
{
    return (size_t)voxels[0] * (size_t)voxels[1] * (size_t)voxels[2];
}

/* ---- a frame */

/* What the particles are now; where the others went is counted as they go. */
static status count_rock(struct model *m)
{
    status st = OK;
    uint32_t n_deposits = 0;
    if (m->blocks.rubble)
        return collapse_count(m->gpu, &m->particles, &m->ledger);
    if (m->deposits)
        TRY(deposit_count(m->gpu, m->work, &m->particles, &n_deposits));
    m->ledger.deposit = n_deposits;
    m->ledger.rock = m->particles.n - n_deposits;
done:
    return st;
}

/* Does what erodes in this frame stay in the domain? */
static bool depositing(const struct model *m)
{
    return m->deposits && curve_at(&m->job->deposition.viability, m->frame) > 0;
}

/* Enters all that the rock has, before and after a process, into the frame's budget. */
static void weigh(struct model *m, uint32_t process, bool after)
{
    budget_sum(m->gpu, &m->budget, process, after, m->particles.field[ROCK_viability], m->particles.n);
}

/* Eroded particles, in a step of the frame, leave, or come to rest elsewhere. Did anything move? */
static status remove_eroded(struct model *m, int step, uint32_t n_eroded, bool *changed)
{
    status st = OK;
    struct deposit_counts moved = {.crumbs = n_eroded, .left = n_eroded};
    if (depositing(m) && (n_eroded > 0 || m->ledger.deposit > 0)) {
        struct deposit_routing routing = {.tag = m->water.tag, .receiver = m->water.receiver};
        memcpy(routing.cells, m->water.cells, sizeof routing.cells);
        memcpy(routing.shift, m->water.shift, sizeof routing.shift);
        gpu_stage(m->gpu, "deposition");
        weigh(m, BUDGET_DEPOSITION, false);
        TRY(deposit_land(m->gpu, m->work, &m->deposit, m->job, m->frame, step, &routing, &m->particles,
                         &moved));
        weigh(m, BUDGET_DEPOSITION, true);
    }
    m->ledger.left += moved.left;
    *changed = moved.crumbs > 0;
    gpu_stage(m->gpu, "particles");
    if (*changed) {
        TRY(particles_index(m->gpu, m->work, &m->particles));
        TRY(count_rock(m));
    }
done:
    return st;
}

static status remove_unsupported(struct model *m)
{
    status st = OK;
    uint32_t n_fallen = 0;
    gpu_stage(m->gpu, "blocks");
    weigh(m, BUDGET_BLOCKS, false);
    if (m->collapse.falls) {
        TRY(collapse_blocks(m->gpu, m->work, &m->collapse, &m->blocks, &m->particles, &m->ledger));
        weigh(m, BUDGET_BLOCKS, true);
        goto done;
    }
    TRY(blocks_fall(m->gpu, m->work, &m->blocks, &m->particles, &n_fallen));
    m->ledger.fallen += n_fallen;
    if (n_fallen) {
        TRY(particles_index(m->gpu, m->work, &m->particles));
        TRY(count_rock(m));
    }
    weigh(m, BUDGET_BLOCKS, true);
done:
    return st;
}

/* Stress by the job's solver. The displacement is a resumed run's already: `solved`. */
static status solve(struct model *m, bool solved)
{
    status st = OK;
    struct elastic *e = &m->elastic;
    if (m->job->stress.solver == STRESS_MPM) {
        const struct mpm_options material = {.lambda = e->options.lambda,
                                             .mu = e->options.mu,
                                             .density = e->options.density,
                                             .gravity = e->options.gravity,
                                             .cfl = m->job->collapse.cfl};
        if (!m->mpm.n_max)
            TRY(mpm_create(m->gpu, m->particles.voxels, m->particles.h, m->particles.n_max, &material,
                           &m->mpm));
        m->mpm.options = material;
        TRY(mpm_rest(m->gpu, m->work, &m->mpm, &m->particles, e->options.tolerance, e->options.max_iterations,
                     &e->iterations, &e->error));
        goto done;
    }
    TRY(elastic_assemble(m->gpu, m->work, e, &m->particles));
    if (!solved)
        TRY(elastic_solve(m->gpu, m->work, e));
    elastic_recover(m->gpu, e, &m->particles);
done:
    return st;
}

/* What follows from the shape: surface, normals, stress, erodibility. Rock in motion has its stress. */
static status settle(struct model *m, bool solved)
{
    status st = OK;
    gpu_stage(m->gpu, "surface");
    TRY(particles_surface(m->gpu, m->work, &m->particles));
    gpu_stage(m->gpu, "stress");
    if (!m->collapse.shot)
        TRY(solve(m, solved));
    if (m->elastic.iterations >= m->elastic.options.max_iterations)
        log_warn("frame %d: stress stopped after %d iterations with an error of %.2g (stress.max_iterations, "
                 "stress.tolerance %.2g)",
                 m->frame, m->elastic.iterations, m->elastic.error, m->elastic.options.tolerance);
    gpu_stage(m->gpu, "erodibility");
    TRY(erosion_interlock(m->gpu, &m->erosion, m->job, m->frame, &m->particles));
    if (m->plants)
        plants_bind(m->gpu, m->job, &m->particles);
done:
    return st;
}

/* What lasts from frame to frame and depends on the number of particles. */
static status create_particles(struct model *m, const struct rock *rock)
{
    status st = OK;
    int voxels[3];
    TRY(scene_voxels(m->job, voxels));
    TRY(particles_create(m->gpu, m->work, rock, STATE, voxels, m->job->domain.spacing_m, &m->particles));
    TRY(erosion_create(m->gpu, m->job, m->particles.n_max, &m->erosion));
    TRY(collapse_create(m->gpu, m->job, &m->particles, &m->collapse));
    m->blocks.rubble |= m->collapse.falls;
    for (size_t i = 0; i < rock->n && !m->blocks.rubble; i++)
        m->blocks.rubble = rock->phase[i] == PHASE_FALLING;
done:
    return st;
}

static void destroy_particles(struct model *m)
{
    mpm_destroy(m->gpu, &m->mpm);
    collapse_destroy(m->gpu, &m->collapse);
    erosion_destroy(m->gpu, &m->erosion);
    particles_destroy(m->gpu, &m->particles);
}

static struct elastic_options elastic_options(const struct job *job)
{
    return (struct elastic_options){
        .lambda = 1e9 * job->rock.lame_GPa,
        .mu = 1e9 * job->rock.shear_GPa,
        .density = job->rock.density_kg_m3,
        .gravity = job->rock.gravity_m_s2,
        .tolerance = job->stress.tolerance,
        .max_iterations = (int)job->stress.max_iterations,
    };
}

/* Does anything in the job need to know where water runs? */
static bool routes(const struct job *job)
{
    return water_ever_flows(job) || deposit_wanted(job);
}

/* Does the job want that, now or once edited? */
static bool ever(const struct job *job, bool (*wanted)(const struct job *))
{
    bool any = wanted(job);
    for (size_t i = 0; i < job->n_edits && !any; i++)
        any = job->edits[i].set.job && wanted(job->edits[i].set.job);
    return any;
}

/* For the job as it is now. */
static status create_water(struct model *m)
{
    status st = OK;
    int voxels[3];
    TRY(scene_voxels(m->job, voxels));
    if (routes(m->job))
        TRY(water_create(m->gpu, m->job, voxels, m->job->domain.spacing_m, &m->water));
done:
    return st;
}

/* Where water, and what breaks off, runs in a step, and what water cuts. *kyr, the step, becomes shorter where
 * water is fast; cut into parts of `least` it would not be into fewer. */
static status run_water(struct model *m, int step, double least, double *kyr)
{
    status st = OK;
    const struct job *job = m->job;
    bool deposits = depositing(m), flows = water_flows(job, m->frame);
    struct water_routing how = {.seed = (uint32_t)job->seed,
                                .frame = m->frame,
                                .step = step,
                                .leak = job->rain.leak,
                                .cells = deposits};
    double fastest;
    gpu_stage(m->gpu, "water");
    if (deposits || flows)
        TRY(water_route(m->gpu, m->work, &m->water, &how, &m->particles));
    if (!flows)
        goto done;
    TRY(water_discharge(m->gpu, m->work, &m->water, job, m->frame, &m->particles));
    if (deposits)
        water_sweep(m->gpu, &m->water, job, &m->particles);
    water_erode(m->gpu, &m->water, job, m->frame, least, &m->particles, m->erosion.intensity,
                m->erosion.parts);
    TRY(erosion_pace(m->gpu, m->work, &m->erosion, &m->particles, &fastest));
    if (fastest * least > 0.999 * (double)WATER_DEPTH * job->domain.spacing_m && !m->told) {
        log_warn("frame %d: water would cut deeper than %g spacings in a step and is held to that: raise "
                 "rain.steps (%d), or lower rain.erosion",
                 m->frame, (double)WATER_DEPTH, (int)job->rain.steps);
        m->told = true;
    }
    /* Equal parts: at most as many as `least` goes into *kyr, now and after each. */
    if (fastest * *kyr > WATER_STEP * job->domain.spacing_m)
        *kyr /= ceil(*kyr / fmax(least, WATER_STEP * job->domain.spacing_m / fastest) - 1e-6);
done:
    return st;
}

/* A frame's edits: what they set and what they do to the rock. */
static status edit(struct model *m)
{
    status st = OK;
    struct rock rock = {0};
    enum edits_kind kind = edits_of(m->whole, m->frame);
    m->job = job_at(m->whole, m->frame);
    if (kind == EDITS_NONE)
        return OK;
    gpu_stage(m->gpu, "edits");
    m->elastic.options = elastic_options(m->job);
    water_destroy(m->gpu, &m->water);
    TRY(create_water(m));
    if (kind != EDITS_ROCK) {
        collapse_destroy(m->gpu, &m->collapse);
        TRY(collapse_create(m->gpu, m->job, &m->particles, &m->collapse));
        m->blocks.rubble |= m->collapse.falls;
    }
    if (kind == EDITS_ROCK) {
        weigh(m, BUDGET_EDITS, false);
        TRY(particles_download(m->gpu, &m->particles, STATE, &rock));
        TRY(edits_apply(m->whole, m->frame, &rock, &m->ledger, &m->start_volume));
        destroy_particles(m);
        TRY(create_particles(m, &rock));
        weigh(m, BUDGET_EDITS, true);
        TRY(count_rock(m));
        if (!m->collapse.shot)
            TRY(remove_unsupported(m));
    }
    if (m->collapse.shot) /* from here on */
        TRY(collapse_load(m->gpu, &m->collapse, &m->particles));
    TRY(settle(m, false));
done:
    rock_free(&rock);
    return st;
}

/* One step of up to *kyr. */
static status erode(struct model *m, int step, double least, double *kyr)
{
    status st = OK;
    uint32_t n_eroded;
    bool changed;
    gpu_stage(m->gpu, "wind");
    TRY(wind_update(m->gpu, &m->wind, m->job, m->frame, &m->particles));
    wind_erode(m->gpu, &m->wind, m->job, m->frame, &m->particles, m->erosion.intensity, m->erosion.parts);
    TRY(run_water(m, step, least, kyr));
    if (m->plants)
        plants_shield(m->gpu, m->job, &m->particles, m->erosion.intensity);
    gpu_stage(m->gpu, "viability");
    TRY(erosion_weather(m->gpu, m->work, &m->erosion, *kyr, &m->particles, &m->budget, &n_eroded));
    TRY(remove_eroded(m, step, n_eroded, &changed));
    if (changed)
        TRY(remove_unsupported(m));
    TRY(settle(m, false));
done:
    return st;
}

static status step(struct model *m)
{
    status st = OK;
    m->frame++;
    budget_clear(m->gpu, &m->budget);
    TRY(edit(m));
    m->years += m->job->clock.years_per_frame;
    if (m->collapse.shot) {
        gpu_stage(m->gpu, "collapse");
        weigh(m, BUDGET_COLLAPSE, false);
        TRY(collapse_frame(m->gpu, m->work, &m->collapse, m->job->clock.seconds_per_frame, &m->particles,
                           &m->ledger));
        weigh(m, BUDGET_COLLAPSE, true);
        TRY(settle(m, false));
        TRY(budget_read(m->gpu, &m->budget, m->change));
        goto done;
    }
    if (m->plants) {
        gpu_stage(m->gpu, "plants");
        plants_grow(m->gpu, m->job, m->frame, &m->particles);
    }
    int steps = erosion_steps(m->job, m->frame, wind_intensity(m->job, m->frame)), number = 0;
    double whole = m->job->clock.years_per_frame / 1000 / steps, least = whole / (double)m->job->rain.steps;
    for (int i = 0; i < steps; i++)
        for (double left = whole, kyr; left > 0 && m->particles.n > 0; left -= kyr) {
            kyr = left;
            TRY(erode(m, number++, fmin(least, left), &kyr));
        }
    TRY(budget_read(m->gpu, &m->budget, m->change));
done:
    return st;
}

/* ---- what a frame shows */

static double volume_of(const struct job *job, const struct rock *rock)
{
    double volume = 0;
    for (size_t i = 0; i < rock->n; i++)
        volume += (double)rock->viability[i];
    return volume * pow(job->domain.spacing_m, 3);
}

static status measure(const struct model *m, struct frame *out)
{
    const struct rock *rock = &out->rock;
    double most = 0;
    for (size_t i = 0; i < rock->n; i++) {
        double stress = fabs((double)rock->stress[i]), viability = (double)rock->viability[i];
        if (!isfinite(stress) || !isfinite(viability))
            return fail(E_NUMERIC,
                        "frame %d: particle %u has stress %g Pa and viability %g; stopped before writing it",
                        m->frame, (unsigned)rock->id[i], (double)rock->stress[i], viability);
        most = fmax(most, stress);
    }
    out->volume_m3 = volume_of(m->job, rock);
    out->start_volume_m3 = m->start_volume;
    out->max_stress_Pa = most;
    for (size_t i = 0; i < BUDGET_ROWS; i++)
        if (i != BUDGET_WEATHERING)
            out->change[out->n_changes++] =
                (struct frame_change){budget_names[i], budget_m3(m->change[i], m->job->domain.spacing_m)};
    return OK;
}

/* The discharge over the shape as it is now. One grid and one set of choices for all frames, so that streams
 * move only where the rock has changed. */
static status show_water(struct model *m)
{
    status st = OK;
    struct water_routing how = {.seed = (uint32_t)m->job->seed, .leak = m->job->rain.leak};
    if (!water_flows(m->job, m->frame)) {
        gpu_fill(m->gpu, m->particles.field[ROCK_discharge], 0);
        return OK;
    }
    gpu_stage(m->gpu, "water");
    TRY(water_route(m->gpu, m->work, &m->water, &how, &m->particles));
    TRY(water_discharge(m->gpu, m->work, &m->water, m->job, m->frame, &m->particles));
    water_show(m->gpu, &m->water, &m->particles);
done:
    return st;
}

/* Which values of the surface this job can have. */
static size_t skin_fields(const struct model *m, enum rock_field out[3])
{
    const struct job *job = m->job;
    size_t n = 0;
    if (water_ever_flows(job))
        out[n++] = ROCK_discharge;
    if (m->plants)
        out[n++] = ROCK_vegetation;
    if (m->deposits)
        out[n++] = ROCK_phase;
    return n;
}

static status output(struct model *m, struct frame *out)
{
    status st = OK;
    const struct job *job = m->job;
    enum rock_field skin[3];
    size_t n_skin = skin_fields(m, skin);
    struct aov_air air = {0};
    *out = (struct frame){.number = m->frame,
                          .years = m->years,
                          .ledger = m->ledger,
                          .stress_iterations = m->elastic.iterations};
    TRY(show_water(m));
    gpu_stage(m->gpu, "field");
    field_build(m->gpu, &m->field, &m->particles);
    TRY(particles_download(m->gpu, &m->particles, DERIVED, &out->rock));
    TRY(measure(m, out));
    TRY(rocks_on_deposits(job, &out->rock, &m->tile, &out->rocks));
    TRY(field_download(m->gpu, &m->field, &m->particles, skin, n_skin, &out->grids));
    TRY(air_add(m->gpu, &m->wind, job, m->frame, &out->grids));
    gpu_stage(m->gpu, "pictures");
    TRY(air_upload(m->gpu, &out->grids, job, m->frame, &air));
    TRY(aov_render_all(m->gpu, &m->aov, job, &m->field, &m->particles, &air, out));
done:
    gpu_buffer_destroy(m->gpu, &air.velocity);
    if (st != OK)
        frame_free(out);
    return st;
}

/* ---- the state */

/* What the displacement depends on beside the rock's shape. */
enum { ELASTICITY = 4 };

static void elasticity(const struct model *m, double out[ELASTICITY])
{
    const struct elastic_options *e = &m->elastic.options;
    const double numbers[ELASTICITY] = {e->lambda, e->mu, e->density, e->gravity};
    memcpy(out, numbers, sizeof numbers);
}

static status save(struct model *m, struct checkpoint *out)
{
    status st = OK;
    void *data;
    size_t n = m->particles.n, nodes = elastic_nodes(&m->elastic);
    *out = (struct checkpoint){.frame = m->frame, .years = m->years};
    TRY(section_add_domain(out, m->job));
    for (int f = 0; f < ROCK_FIELDS; f++) {
        if (rock_field_table[f].keep != STATE)
            continue;
        /* Shuffled by float, whatever the field's width. */
        TRY(section_add(out, rock_field_table[f].name, 4, n * (size_t)rock_field_table[f].components, &data));
        TRY(gpu_download(m->gpu, m->particles.field[f], 0, data, n));
    }
    TRY(section_add(out, "displacement", 4, 4 * nodes, &data));
    TRY(gpu_download(m->gpu, m->elastic.u, 0, data, nodes));
    TRY(section_add(out, "ledger", 8, sizeof m->ledger / 8, &data));
    memcpy(data, &m->ledger, sizeof m->ledger);
    TRY(section_add(out, "start volume", 8, 1, &data));
    memcpy(data, &m->start_volume, sizeof m->start_volume);
    TRY(section_add(out, "change", 8, BUDGET_ROWS, &data));
    memcpy(data, m->change, sizeof m->change);
    TRY(section_add(out, "iterations", 4, 1, &data));
    memcpy(data, &m->elastic.iterations, 4);
    TRY(section_add(out, "elasticity", 8, ELASTICITY, &data));
    elasticity(m, data);
    TRY(section_add(out, "processes", 8, 2, &data));
    memcpy(data, (const double[]){m->deposits, m->plants}, 2 * sizeof(double));
    if (m->wind.flows)
        TRY(air_save(m->gpu, &m->wind, out));
    if (m->collapse.shot)
        TRY(collapse_save(m->gpu, &m->collapse, out));
done:
    if (st != OK)
        checkpoint_free(out);
    return st;
}

/* *settled: the displacement is that of this job's rock. A branch may have changed what it depends on. */
static status restore(struct model *m, const struct checkpoint *c, bool *settled)
{
    status st = OK;
    struct rock rock = {0};
    const struct checkpoint_section *s;
    double now[ELASTICITY];
    TRY(section_check_domain(c, m->job));
    elasticity(m, now);
    TRY(section_find(c, "elasticity", 8, ELASTICITY, &s));
    *settled = memcmp(s->data, now, sizeof now) == 0;
    TRY(section_find(c, "id", 4, 0, &s));
    rock.n = s->n;
    for (int f = 0; f < ROCK_FIELDS; f++) {
        const struct rock_field_info *info = &rock_field_table[f];
        if (info->keep != STATE)
            continue;
        TRY(section_find(c, info->name, 4, rock.n * (size_t)info->components, &s));
        rock.field[f] = s->data; /* borrowed: not freed here */
    }
    TRY(section_find(c, "ledger", 8, sizeof m->ledger / 8, &s));
    memcpy(&m->ledger, s->data, sizeof m->ledger);
    TRY(section_find(c, "start volume", 8, 1, &s));
    memcpy(&m->start_volume, s->data, sizeof m->start_volume);
    TRY(section_find(c, "change", 8, BUDGET_ROWS, &s));
    memcpy(m->change, s->data, sizeof m->change);
    TRY(section_find(c, "iterations", 4, 1, &s));
    memcpy(&m->elastic.iterations, s->data, 4);
    TRY(section_find(c, "displacement", 4, 4 * elastic_nodes(&m->elastic), &s));
    TRY(gpu_upload(m->gpu, m->elastic.u, 0, s->data, elastic_nodes(&m->elastic)));
    TRY(section_find(c, "processes", 8, 2, &s));
    m->deposits |= ((const double *)s->data)[0] != 0;
    m->plants |= ((const double *)s->data)[1] != 0;
    if (m->wind.flows)
        TRY(air_restore(m->gpu, &m->wind, c));
    TRY(create_particles(m, &rock));
    /* A shot may begin where years have passed. */
    if (m->collapse.shot && checkpoint_find(c, mpm_word_names[MPM_ID], 4))
        TRY(collapse_restore(m->gpu, &m->collapse, &m->particles, c));
    else if (m->collapse.shot)
        TRY(collapse_load(m->gpu, &m->collapse, &m->particles));
done:
    return st;
}

static status begin(struct model *m)
{
    status st = OK;
    struct rock rock = {0};
    TRY(scene_sample(m->whole, &rock));
    m->ledger = (struct ledger){.start = rock.n, .rock = rock.n};
    TRY(edits_apply(m->whole, m->frame, &rock, &m->ledger, &m->start_volume));
    for (size_t i = 0; i < rock.n && !m->deposits; i++)
        m->deposits = rock.phase[i] == PHASE_DEPOSIT; /* a scene of stacks has loose ground */
    TRY(create_particles(m, &rock));
    TRY(count_rock(m));
    if (m->collapse.shot)
        TRY(collapse_load(m->gpu, &m->collapse, &m->particles));
    else
        TRY(remove_unsupported(m));
    if (m->ledger.fallen && !m->blocks.rubble)
        log_warn("frame %d: %llu of %llu particles have no face path to the ground and were taken out",
                 m->frame, (unsigned long long)m->ledger.fallen, (unsigned long long)m->ledger.start);
    rock_free(&rock);
    TRY(particles_download(m->gpu, &m->particles, STATE, &rock));
    m->start_volume = volume_of(m->job, &rock);
done:
    rock_free(&rock);
    return st;
}

static void destroy(struct model **handle)
{
    struct model *m = *handle;
    if (!m)
        return;
    aov_destroy(m->gpu, &m->aov);
    field_destroy(m->gpu, &m->field);
    deposit_destroy(m->gpu, &m->deposit);
    blocks_destroy(m->gpu, &m->blocks);
    wind_destroy(m->gpu, &m->wind);
    water_destroy(m->gpu, &m->water);
    elastic_destroy(m->gpu, &m->elastic);
    destroy_particles(m);
    budget_destroy(m->gpu, &m->budget);
    gpu_work_destroy(m->gpu, &m->work);
    pile_tile_destroy(&m->tile);
    free(m);
    *handle = NULL;
}

static status create(struct gpu *gpu, const struct job *job, const struct checkpoint *from,
                     struct model **out)
{
    status st = OK;
    struct model *m = NULL;
    int voxels[3];
    double h = job->domain.spacing_m;
    bool settled = false;
    TRY(memory_alloc(1, sizeof *m, "the model", &m));
    m->gpu = gpu;
    m->whole = job;
    m->frame = from ? from->frame : job->frames.first;
    m->years = from ? from->years : 0;
    m->job = job_at(job, m->frame);
    struct elastic_options options = elastic_options(m->job);
    gpu_stage(gpu, "start");
    TRY(scene_voxels(job, voxels));
    size_t nodes = mpm_nodes(voxels);
    TRY(gpu_work_create(gpu, (nodes > voxel_count(voxels) ? nodes : voxel_count(voxels)) + 2, &m->work));
    TRY(elastic_create(gpu, voxels, h, &options, &m->elastic));
    TRY(blocks_create(gpu, voxels, &m->blocks));
    TRY(budget_create(gpu, &m->budget));
    m->plants = plants_wanted(job) || edits_plant(job);
    m->deposits = ever(job, deposit_wanted);
    TRY(wind_create(gpu, job, voxels, &m->wind));
    TRY(rocks_tile(job, &m->tile));
    TRY(field_create(gpu, voxels, h, &m->field));
    if (aov_pixels(job))
        TRY(aov_create(gpu, job, aov_pixels(job), &m->aov));
    TRY(scene_edits_check(job, m->frame));
    TRY(from ? restore(m, from, &settled) : begin(m));
    if (m->deposits)
        TRY(deposit_create(gpu, voxels, &m->deposit));
    TRY(create_water(m));
    TRY(settle(m, settled));
    *out = m;
    m = NULL;
done:
    destroy(&m);
    return st;
}

static status estimate(const struct job *job, struct model_estimate *out)
{
    status st = OK;
    size_t pixels = aov_pixels(job), n;
    struct scene_size size = {0};
    *out = (struct model_estimate){0};
    TRY(scene_voxels(job, out->voxels));
    TRY(scene_estimate(job, &size));
    TRY(wind_check(job, out->voxels));
    out->n_particles = n = size.n_particles;
    size_t voxels = voxel_count(out->voxels);
    uint64_t rock = 0, field = field_bytes(out->voxels);
    for (int f = 0; f < ROCK_FIELDS; f++)
        rock += n * rock_field_size((enum rock_field)f);
    out->device_bytes =
        gpu_work_bytes(voxels + 2) + particles_bytes(n, out->voxels) + elastic_bytes(out->voxels) +
        erosion_bytes(n) + blocks_bytes(out->voxels) + wind_bytes(job, out->voxels) + field +
        aov_bytes(pixels) + (ever(job, routes) ? water_bytes(out->voxels) : 0) +
        (ever(job, deposit_wanted) ? deposit_bytes(out->voxels) : 0) + collapse_bytes(job, n, out->voxels) +
        (job->stress.solver == STRESS_MPM ? mpm_bytes(n, out->voxels, job->domain.spacing_m, 0) : 0);
    /* Two frames wait at most; files are made in memory. */
    uint64_t picture = aov_picture_bytes(job);
    out->host_bytes = 3 * (rock + field + picture * job->output.aov.n_cameras);
    /* Water, plants and deposits have volumes of their own. */
    double skins =
        0.1 * (water_ever_flows(job) + (plants_wanted(job) || edits_plant(job)) + ever(job, deposit_wanted));
    out->disk = disk_frame(job, &size, &(struct disk_particle){15.5, 45, 2.2, 88 * (1 + skins), 1.9});
    out->checkpoint_bytes = 15 * (uint64_t)n +
                            (uint64_t)(0.3 * (double)wind_checkpoint_bytes(job, out->voxels)) +
                            collapse_checkpoint_bytes(job, n);
    for (int f = job->frames.first + 1; f <= job->frames.last; f++)
        out->steps += erosion_steps(job_at(job, f), f, wind_intensity(job_at(job, f), f));
done:
    free(size.point);
    return st;
}

static int frame(const struct model *m)
{
    return m->frame;
}

const struct model_type arenite = {
    .name = "arenite",
    .estimate = estimate,
    .create = create,
    .destroy = destroy,
    .step = step,
    .frame = frame,
    .output = output,
    .save = save,
};
