/* Arenite: sandstone as particles that erode where wind and water reach them and stress does not strengthen them (Yang et al. 2025,
 * algorithm 1).
 *
 * One frame is a list of stages (gpu_stage()), each named as in log/timing.jsonl:
 *
 *   edits         edit()                       what the frame's edits set and change
 *   plants        plants_grow()                once per frame
 *   and then, until the frame's years have passed, parts of steps, each of which is:
 *   wind          find_intensity()             abrasion and deflation
 *   water         find_intensity()             flow paths, discharge and incision; then groundwater, sheeting, structure
 *   viability     erosion_weather()            viability lost in the longest part that all of these allow
 *   blocks        crumble()                    small unsupported pieces
 *   deposition    remove_eroded()              eroded particles are deposited, or leave the domain
 *   particles     particles_index()            the index of the particles, whenever they have moved
 *   blocks        arenite_remove_unsupported() unsupported blocks fall or are removed
 *   surface       arenite_update_derived()     surface particles and normals
 *   stress        arenite_update_derived()     after the last part of a step, or if much rock has gone or fallen
 *   erodibility   arenite_update_derived()     from stress, plants, groundwater and exposure
 *
 * A shot has the stages edits, collapse, surface, erodibility instead. output() then adds the stages field and pictures.
 *
 * The state between frames consists of the particles, the displacement on the stress grid, the air and the ledger. Everything else is
 * recomputed from these, so that a resumed run has the same bits.
 */
#include "model/arenite.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/log.h"
#include "base/memory.h"
#include "frame/rocks.h"
#include "model/air.h"
#include "model/arenite_deep.h"
#include "model/edits.h"
#include "model/inside.h"
#include "plants/plants.h"
#include "sheeting/sheeting.h"

/* Spacings that the fastest rock and the fastest deposits may lose in one part of a step. An eroded deposit comes to rest elsewhere once
 * per part, so a part must not be longer than the life of a deposit. */
static const double ROCK_STEP = 1.5, LOOSE_STEP = 0.7;

/* The same for rock if groundwater seeps: erosion beyond a particle continues into its neighbours, whether they are wet or not. */
static const double SEEPING_STEP = 0.35;

/* Share of the time in which the fastest channel bed would be lowered to its receiver. */
static const double SLOPE_STEP = 1;

/* Spacings that rock may lose between two solutions of the stress within a step. */
static const double STRESS_STEP = 0.5;

/* The most rounds of deposition in a part of a step, for fragments that find no free place or keep sliding. Deposits are at rest when at
 * most one in FEW_OF still slides. */
enum { LANDINGS = 200, FEW_OF = 400 };

/* ---- a frame */

status arenite_count(struct arenite *a)
{
    status st = OK;
    uint32_t n_deposits = 0;
    if (a->blocks.rubble)
        return collapse_count(a->m.gpu, &a->particles, &a->m.ledger);
    if (a->deposits)
        TRY(deposit_count(a->m.gpu, a->m.work, &a->particles, &n_deposits));
    a->m.ledger.deposit = n_deposits;
    a->m.ledger.rock = a->particles.n + a->particles.n_deep - n_deposits;
done:
    return st;
}

/* Whether eroded particles are deposited in this frame. */
static bool depositing(const struct arenite *a)
{
    return a->deposits && curve_at(&a->m.job->deposition.viability, a->m.frame) > 0;
}

static void budget_before(struct arenite *a, enum process process)
{
    model_budget_before(&a->m, process, a->particles.field[ROCK_viability], a->particles.n);
}

static void budget_after(struct arenite *a, enum process process)
{
    model_budget_after(&a->m, process, a->particles.field[ROCK_viability], a->particles.n);
}

static status find_surface(struct arenite *a)
{
    status st = OK;
    gpu_stage(a->m.gpu, "surface");
    TRY(arenite_add_due(a, DUE_NEAR, 0));
    TRY(particles_surface(a->m.gpu, a->m.work, &a->particles));
done:
    return st;
}

/* Finds the flow paths of water and of eroded fragments over the present shape. `step` is the part's number in the frame, for random
 * numbers. */
static status route(struct arenite *a, int step)
{
    status st = OK;
    const struct job *job = a->m.job;
    const bool deposits = depositing(a), flows = water_flows(job, a->m.frame);
    struct water_routing how = {.seed = (uint32_t)job->seed,
                                .frame = a->m.frame,
                                .step = step,
                                .leak = job->rain.leak,
                                .cells = deposits};
    gpu_stage(a->m.gpu, "water");
    if (deposits)
        TRY(water_route(a->m.gpu, a->m.work, &a->fragments.routing, &how, &a->particles));
    if (!flows)
        goto done;
    how.cells = false;
    TRY(water_route(a->m.gpu, a->m.work, &a->water, &how, &a->particles));
    TRY(water_discharge(a->m.gpu, a->m.work, &a->water, job, a->m.frame, &a->particles));
    if (deposits)
        water_sweep(a->m.gpu, &a->water, job, &a->particles, &a->fragments);
done:
    return st;
}

/* Fragments come to rest or leave; or they wait, unless this is the last landing. */
static status land(struct arenite *a, int step, bool last, struct deposit_counts *moved)
{
    status st = OK;
    const struct water *paths = &a->fragments.routing;
    struct deposit_routing routing = {.tag = paths->tag, .receiver = paths->receiver};
    memcpy(routing.cells, paths->cells, sizeof routing.cells);
    memcpy(routing.shift, paths->shift, sizeof routing.shift);
    gpu_stage(a->m.gpu, "deposition");
    budget_before(a, PROCESS_DEPOSITION);
    TRY(deposit_land(a->m.gpu, a->m.work, &a->deposit, a->m.job, a->m.frame, step, &routing, &a->particles,
                     last, moved));
    budget_after(a, PROCESS_DEPOSITION);
    a->m.ledger.left += moved->left;
    gpu_stage(a->m.gpu, "particles");
    if (moved->waiting)
        TRY(particles_index_waiting(a->m.gpu, a->m.work, &a->particles));
    else if (moved->fragments)
        TRY(particles_index(a->m.gpu, a->m.work, &a->particles));
done:
    return st;
}

/* Repeats rounds of deposition until fragments are at rest, independent of the length of the step. A few that keep each other moving
 * continue to slide in later steps. */
static status land_all(struct arenite *a, int step, bool *changed)
{
    status st = OK;
    struct deposit_counts moved;
    bool last = false;
    const uint64_t few = a->m.ledger.deposit / FEW_OF;
    TRY(land(a, step, last, &moved));
    *changed = moved.fragments > 0;
    for (int n = 1; !last && (moved.slid > few || moved.waiting > 0); n++) {
        last = n == LANDINGS || moved.landed + moved.left == 0 || moved.slid + moved.waiting <= few;
        if (water_flows(a->m.job, a->m.frame))
            TRY(find_surface(a));
        TRY(route(a, step | n << 16));
        TRY(land(a, step | n << 16, last, &moved));
    }
    if (*changed)
        TRY(arenite_count(a));
done:
    return st;
}

/* Eroded particles are deposited elsewhere or leave. *changed: any particle moved. */
static status remove_eroded(struct arenite *a, int step, uint32_t n_eroded, bool *changed)
{
    status st = OK;
    if (depositing(a) && (n_eroded > 0 || a->m.ledger.deposit > 0))
        return land_all(a, step, changed);
    gpu_stage(a->m.gpu, "particles");
    a->m.ledger.left += n_eroded;
    *changed = n_eroded > 0;
    if (*changed) {
        TRY(particles_index(a->m.gpu, a->m.work, &a->particles));
        TRY(arenite_count(a));
    }
done:
    return st;
}

/* Finds the blocks and which of them are connected to the ground. Afterwards, unconnected blocks have all of their particles. Eroded
 * particles are still included. */
static status find_blocks(struct arenite *a)
{
    status st = OK;
    size_t n_cut;
    TRY(blocks_find(a->m.gpu, a->m.work, &a->blocks, &a->particles, &n_cut));
    if (n_cut) {
        TRY(arenite_add_due(a, DUE_CHOSEN, n_cut));
        TRY(blocks_find(a->m.gpu, a->m.work, &a->blocks, &a->particles, &n_cut));
    }
done:
    return st;
}

/* Unsupported pieces that are too small to fall as blocks are counted as eroded particles. */
static status crumble(struct arenite *a, uint32_t *n_eroded)
{
    status st = OK;
    uint32_t n_fragments;
    size_t n_loose;
    if (!a->collapse.falls || *n_eroded == 0)
        return OK;
    gpu_stage(a->m.gpu, "blocks");
    TRY(find_blocks(a));
    budget_before(a, PROCESS_BLOCKS);
    TRY(collapse_crumble(a->m.gpu, a->m.work, &a->collapse, &a->blocks, &a->particles, &n_fragments,
                         &n_loose));
    budget_after(a, PROCESS_BLOCKS);
    *n_eroded += n_fragments;
done:
    return st;
}

status arenite_remove_unsupported(struct arenite *a)
{
    status st = OK;
    uint32_t n_fallen = 0;
    gpu_stage(a->m.gpu, "blocks");
    TRY(find_blocks(a));
    budget_before(a, PROCESS_BLOCKS);
    if (a->collapse.falls) {
        TRY(collapse_blocks(a->m.gpu, a->m.work, &a->collapse, &a->blocks, &a->particles, &a->m.ledger));
        budget_after(a, PROCESS_BLOCKS);
        goto done;
    }
    TRY(blocks_fall(a->m.gpu, a->m.work, &a->blocks, &a->particles, &n_fallen));
    a->m.ledger.fallen += n_fallen;
    if (n_fallen) {
        TRY(particles_index(a->m.gpu, a->m.work, &a->particles));
        TRY(arenite_count(a));
    }
    budget_after(a, PROCESS_BLOCKS);
done:
    return st;
}

/* Computes the stress with the job's solver. `solved`: the displacement was restored from a checkpoint and is the solution already. */
static status solve(struct arenite *a, bool solved)
{
    status st = OK;
    struct elastic *e = &a->elastic;
    if (a->m.job->stress.solver == STRESS_MPM) {
        const struct mpm_options material = {.lambda = e->options.lambda,
                                             .mu = e->options.mu,
                                             .density = e->options.density,
                                             .gravity = e->options.gravity,
                                             .cfl = a->m.job->collapse.cfl,
                                             .walls = a->particles.walls};
        if (!a->mpm.n_max)
            TRY(mpm_create(a->m.gpu, a->particles.voxels, a->particles.h, a->particles.n_max, &material,
                           &a->mpm));
        a->mpm.options = material;
        TRY(mpm_rest(a->m.gpu, a->m.work, &a->mpm, &a->particles, e->options.tolerance,
                     e->options.max_iterations, &e->iterations, &e->error));
        goto done;
    }
    TRY(elastic_assemble(a->m.gpu, a->m.work, e, &a->particles));
    if (!solved)
        TRY(elastic_solve(a->m.gpu, a->m.work, e));
    elastic_recover(a->m.gpu, e, &a->particles);
done:
    return st;
}

/* Computes the erodibility from the stress, and its changes by groundwater, roots and exposure. */
static status find_rates(struct arenite *a)
{
    status st = OK;
    gpu_stage(a->m.gpu, "erodibility");
    TRY(erosion_interlock(a->m.gpu, &a->erosion, a->m.job, a->m.frame, &a->particles));
    if (a->seeps)
        TRY(groundwater_find(a->m.gpu, &a->groundwater, a->m.job, a->m.frame, a->erosion.layers,
                             &a->particles));
    if (a->plants)
        plants_bind(a->m.gpu, a->m.job, &a->particles);
    if (a->exposed)
        skin_find(a->m.gpu, &a->skin, a->m.job, &a->particles);
done:
    return st;
}

status arenite_set_start_age(struct arenite *a)
{
    status st = OK;
    TRY(find_surface(a));
    skin_begin(a->m.gpu, a->m.job, &a->particles);
done:
    return st;
}

status arenite_update_derived(struct arenite *a, bool solved)
{
    status st = OK;
    TRY(find_surface(a));
    gpu_stage(a->m.gpu, "stress");
    if (!arenite_uses_stress_grid(a->m.job))
        TRY(elastic_clear(a->m.gpu, &a->elastic));
    if (!a->collapse.shot)
        TRY(solve(a, solved));
    if (a->elastic.iterations >= a->elastic.options.max_iterations)
        log_warn(
            "frame %d: the stress solver stopped after %d iterations with an error of %.2g, above stress.tolerance (%.2g); raise stress.max_iterations or stress.tolerance",
            a->m.frame, a->elastic.iterations, a->elastic.error, a->elastic.options.tolerance);
    TRY(find_rates(a));
done:
    return st;
}

/* kyr: the longest part of a step in which neither rock nor deposits lose more than they may, and no channel bed drops below its
 * receiver. */
static double longest_step(const struct arenite *a, const struct erosion_pace *pace)
{
    const double rock = a->seeps ? SEEPING_STEP : ROCK_STEP;
    const double moved = fmin(rock / fmax(pace->rock, 1e-30), LOOSE_STEP / fmax(pace->loose, 1e-30));
    return fmin(a->m.h * moved, SLOPE_STEP / fmax(pace->slopes, 1e-30));
}

/* kyr: length of one of the equal parts into which `kyr` is divided so that they are at most `most` long, but not shorter than `least`. */
static double part_length(double kyr, double least, double most)
{
    return kyr > most ? kyr / ceil(kyr / fmax(least, most) - 1e-6) : kyr;
}

/* Flow paths, and how much water incises; `slopes` receives how fast the slopes of channels change. */
static status run_water(struct arenite *a, int step, struct gpu_buffer *slopes)
{
    status st = OK;
    const struct job *job = a->m.job;
    TRY(route(a, step));
    gpu_fill(a->m.gpu, slopes, 0);
    if (water_flows(job, a->m.frame))
        water_erode(a->m.gpu, &a->water, job, a->m.frame, &a->particles, a->erosion.layers,
                    a->erosion.intensity, a->erosion.parts, slopes);
done:
    return st;
}

/* Applies the frame's edits: the keys that they set, and what they carve, add and paint. */
static status edit(struct arenite *a)
{
    status st = OK;
    struct rock rock = {0};
    enum edits_kind kind = edits_of(a->m.whole, a->m.frame);
    if (kind == EDITS_NONE)
        return OK;
    gpu_stage(a->m.gpu, "edits");
    a->elastic.options = elastic_options(a->m.job, a->maps.stiff);
    arenite_destroy_parts(a, LASTS_JOB);
    TRY(arenite_create_parts(a, LASTS_JOB));
    if (kind != EDITS_ROCK) {
        collapse_destroy(a->m.gpu, &a->collapse);
        TRY(collapse_create(a->m.gpu, a->m.job, &a->particles, &a->collapse));
        a->blocks.rubble |= a->collapse.falls;
        if (a->blocks.rubble || a->collapse.shot)
            TRY(particles_hold_around(a->m.gpu, a->m.work, &a->particles));
    }
    if (kind == EDITS_ROCK) {
        if (a->particles.n_deep)
            log_info("frame %d: an edit of the rock needs particles everywhere: creating all %zu", a->m.frame,
                     a->particles.n + a->particles.n_deep);
        TRY(arenite_add_due(a, DUE_ALL, 0));
        budget_before(a, PROCESS_EDITS);
        TRY(particles_download(a->m.gpu, &a->particles, STATE, &rock));
        TRY(edits_apply(a->m.whole, a->m.frame, &rock, &a->m.ledger, &a->m.start_volume));
        arenite_destroy_particles(a);
        TRY(arenite_create_particles(a, &rock));
        budget_after(a, PROCESS_EDITS);
        TRY(arenite_count(a));
        if (!a->collapse.shot)
            TRY(arenite_remove_unsupported(a));
    }
    if (a->collapse.shot) /* a shot starts in this frame */
        TRY(collapse_load(a->m.gpu, &a->collapse, &a->particles));
    TRY(arenite_update_derived(a, false));
done:
    rock_free(&rock);
    return st;
}

/* A step of erosion, which is divided into parts. */
struct step {
    double whole, left; /* kyr: its length, and what remains of it */
    double moved;       /* spacings that rock has lost since its stress was solved */
    double from;        /* kyr from the first frame to the start of the step */
};

/* Finds how strongly each process acts on the surface: a->erosion.intensity, and its parts by process. */
static status find_intensity(struct arenite *a, int number, const struct step *s, struct gpu_buffer *slopes)
{
    status st = OK;
    const struct job *job = a->m.job;
    gpu_stage(a->m.gpu, "wind");
    TRY(wind_update(a->m.gpu, &a->wind, job, a->m.frame, &a->particles));
    wind_erode(a->m.gpu, &a->wind, job, a->m.frame, &a->particles, a->erosion.layers, a->erosion.intensity,
               a->erosion.parts);
    TRY(run_water(a, number, slopes));
    if (a->maps.along)
        erosion_lead(a->m.gpu, &a->erosion, job, a->maps.along, &a->particles);
    if (erosion_has_aspect(job))
        erosion_aspect(a->m.gpu, &a->erosion, job, &a->particles);
    groundwater_sap(a->m.gpu, &a->groundwater, job, &a->particles, a->erosion.intensity, a->erosion.parts);
    if (sheeting_wanted(job))
        sheeting_press(a->m.gpu, job, s->from, s->whole, &a->particles, a->erosion.intensity,
                       a->erosion.parts);
done:
    return st;
}

/* Plants and crust protect the surface for the `kyr` of a part. */
static void protect(struct arenite *a, double kyr)
{
    if (a->plants)
        plants_shield(a->m.gpu, a->m.job, &a->particles, a->erosion.intensity);
    if (a->exposed)
        skin_age(a->m.gpu, &a->skin, a->m.job, kyr, a->erosion.intensity, &a->particles);
}

/* One part of a step. The stress is solved again at the end of the step, and when much rock has gone or fallen. */
static status erode_part(struct arenite *a, int number, struct step *s)
{
    status st = OK;
    struct erosion_pace pace;
    struct gpu_buffer *slopes = a->particles.taken;
    uint32_t n_eroded;
    bool changed;
    const uint64_t fallen = a->m.ledger.fallen;
    TRY(find_intensity(a, number, s, slopes));
    TRY(erosion_pace(a->m.gpu, a->m.work, &a->erosion, &a->particles, slopes, &pace));
    const double kyr =
        part_length(s->left, s->whole / (double)a->m.job->erosion.parts, longest_step(a, &pace));
    protect(a, kyr);
    gpu_stage(a->m.gpu, "viability");
    TRY(erosion_weather(a->m.gpu, a->m.work, &a->erosion, kyr, &a->particles, a->skin.crust, &a->m.budget,
                        &n_eroded, &a->beyond));
    TRY(crumble(a, &n_eroded));
    if (a->exposed)
        skin_forget(a->m.gpu, &a->particles);
    TRY(remove_eroded(a, number, n_eroded, &changed));
    if (changed)
        TRY(arenite_remove_unsupported(a));
    s->left -= kyr;
    s->moved += pace.rock * kyr / a->m.h;
    if (s->left <= 0 || s->moved > STRESS_STEP || a->m.ledger.fallen != fallen) {
        TRY(arenite_update_derived(a, false));
        s->moved = 0;
    } else {
        TRY(find_surface(a));
        TRY(find_rates(a));
    }
done:
    return st;
}

/* Simulates the frame's years of erosion. */
static status weather(struct arenite *a)
{
    status st = OK;
    const struct job *job = a->m.job;
    const int steps = erosion_steps(job, wind_fastest(job, a->m.frame));
    const double whole = job->clock.years_per_frame / 1000 / steps;
    const double began = (a->m.years - job->clock.years_per_frame) / 1000;
    int number = 0;
    if (a->plants) {
        gpu_stage(a->m.gpu, "plants");
        plants_grow(a->m.gpu, job, a->m.frame, &a->particles);
    }
    for (int i = 0; i < steps; i++)
        for (struct step s = {whole, whole, 0, began + i * whole}; s.left > 0 && a->particles.n > 0;)
            TRY(erode_part(a, number++, &s));
    if (a->beyond >= pow(a->m.h, 3)) {
        log_warn(
            "frame %d: %.3g m3 that should have eroded lie more than %u spacings inside the rock, where one part of a step does not reach; lower erosion.max_step (%g) or raise erosion.parts (%d)",
            a->m.frame, a->beyond, (unsigned)NEAR_REACH, job->erosion.max_step, (int)job->erosion.parts);
        a->beyond = 0;
    }
done:
    return st;
}

/* Simulates the frame's seconds of falling rock. */
static status fall(struct arenite *a)
{
    status st = OK;
    gpu_stage(a->m.gpu, "collapse");
    budget_before(a, PROCESS_COLLAPSE);
    TRY(collapse_frame(a->m.gpu, a->m.work, &a->collapse, a->m.job->clock.seconds_per_frame, &a->particles,
                       &a->m.ledger));
    budget_after(a, PROCESS_COLLAPSE);
    TRY(arenite_update_derived(a, false));
done:
    return st;
}

static status step(struct model *m)
{
    status st = OK;
    struct arenite *a = arenite_of(m);
    TRY(edit(a));
    TRY(a->collapse.shot ? fall(a) : weather(a));
done:
    return st;
}

/* ---- what a frame shows */

/* Fills in the volume, and the largest stress at the surface. */
static status measure(const struct arenite *a, const float *stress, const float *viability, struct frame *out)
{
    status st = OK;
    const struct particles *p = &a->particles;
    uint32_t *surface = NULL;
    double most = 0;
    for (size_t i = 0; i < p->n; i++) {
        if (!isfinite(stress[i]) || !isfinite(viability[i])) {
            uint32_t id;
            TRY(gpu_download(a->m.gpu, p->field[ROCK_id], i, &id, 1));
            st = fail(E_NUMERIC,
                      "frame %d: particle %u has stress %g Pa and viability %g; stopped before writing it",
                      a->m.frame, (unsigned)id, (double)stress[i], (double)viability[i]);
            goto done;
        }
    }
    TRY(memory_alloc(p->n_surface, sizeof *surface, "the surface", &surface));
    TRY(gpu_download(a->m.gpu, p->surface, 0, surface, p->n_surface));
    for (size_t i = 0; i < p->n_surface; i++)
        most = fmax(most, fabs((double)stress[surface[i]]));
    out->volume_m3 = (model_sum(viability, p->n) + (double)p->n_deep) * pow(a->m.h, 3);
    out->max_stress_Pa = most;
done:
    free(surface);
    return st;
}

/* The same for a frame that has no particles: downloads only the two fields that are needed. */
static status measure_alone(const struct arenite *a, struct frame *out)
{
    const struct particles *p = &a->particles;
    status st = OK;
    float *stress = NULL, *viability = NULL;
    TRY(memory_alloc(p->n, sizeof *stress, "stresses", &stress));
    TRY(memory_alloc(p->n, sizeof *viability, "viabilities", &viability));
    TRY(gpu_download(a->m.gpu, p->field[ROCK_stress], 0, stress, p->n));
    TRY(gpu_download(a->m.gpu, p->field[ROCK_viability], 0, viability, p->n));
    TRY(measure(a, stress, viability, out));
done:
    free(stress);
    free(viability);
    return st;
}

/* Computes the discharge to show. The routing grid and its random choices are the same in all frames, so that streams move only where
 * the rock has changed. */
static status show_water(struct arenite *a)
{
    status st = OK;
    struct water_routing how = {.seed = (uint32_t)a->m.job->seed, .leak = a->m.job->rain.leak};
    if (!water_flows(a->m.job, a->m.frame)) {
        gpu_fill(a->m.gpu, a->particles.field[ROCK_discharge], 0);
        return OK;
    }
    gpu_stage(a->m.gpu, "water");
    TRY(water_route(a->m.gpu, a->m.work, &a->water, &how, &a->particles));
    TRY(water_discharge(a->m.gpu, a->m.work, &a->water, a->m.job, a->m.frame, &a->particles));
    water_show(a->m.gpu, &a->water, &a->particles);
done:
    return st;
}

static status output(struct model *m, struct frame *out)
{
    status st = OK;
    struct arenite *a = arenite_of(m);
    const struct frame_wants wants = model_wants(m);
    const unsigned has = arenite_has(m->job, water_ever_flows(m->job), a->plants, a->deposits, a->exposed);
    struct aov_air air = {0};
    out->stress_iterations = a->elastic.iterations;
    if (m->field.cut.keeps != CUT_NONE)
        TRY(arenite_add_at_cut(a, &m->field.cut));
    if (wants.points || wants.volumes || wants.pictures)
        TRY(show_water(a));
    gpu_stage(m->gpu, "field");
    m->field.whole = !arenite_uses_stress_grid(m->job);
    if (wants.volumes || wants.pictures)
        TRY(field_build(m->gpu, m->work, &m->field, &a->particles,
                        m->ledger.deposit ? m->job->deposition.repose_deg : 0));
    if (wants.points || (wants.volumes && a->tile.n)) {
        TRY(particles_download(m->gpu, &a->particles, DERIVED, &out->rock));
        if (wants.points && m->whole->output.vdb.points == VDB_POINTS_ALL)
            TRY(arenite_show_deep(a, &out->deep));
        TRY(measure(a, out->rock.stress, out->rock.viability, out));
    } else {
        TRY(measure_alone(a, out));
    }
    if (wants.volumes) {
        TRY(rocks_on_deposits(m->job, &out->rock, &a->tile, &out->rocks));
        TRY(model_grids(m, has, &out->grids));
        if (!m->field.whole)
            TRY(inside_values(m->gpu, &a->elastic, &out->grids));
    }
    if (wants.air)
        TRY(air_grid(m->gpu, &a->wind, m->job, m->frame, &out->air));
    if (wants.pictures) {
        gpu_stage(m->gpu, "pictures");
        TRY(air_upload(m->gpu, &out->air, m->job, m->frame, &air));
        TRY(aov_render_all(m->gpu, &m->aov, m->job, &m->field, &a->particles, &air, out));
    }
done:
    gpu_buffer_destroy(m->gpu, &air.velocity);
    return st;
}

/* ---- the model */

const struct model_type arenite_type = {
    .size = sizeof(struct arenite),
    .estimate = arenite_estimate,
    .work_items = arenite_work_items,
    .create = arenite_create,
    .begin = arenite_begin,
    .restore = arenite_restore,
    .destroy = arenite_destroy,
    .step = step,
    .watch = arenite_watch,
    .output = output,
    .save = arenite_save,
    .resample = arenite_resample,
};
