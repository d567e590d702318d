/* Arenite: sandstone as particles that weather where wind finds them and stress does not hold them (Yang et
 * al. 2025, algorithm 1).
 *
 * One frame:
 *
 *   edits -> plants -> wind -> water -> viability -> eroded particles, deposits -> unsupported blocks
 *   -> surface, normals -> stress -> erodibility
 *
 * all but the first once or more, until the frame's years have passed; output() then adds the surface field and
 * the pictures.
 * The state between frames is the particles, the grid's displacement, the air and the ledger; the rest is
 * found anew from them, so that a resumed run has the same bits.
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

/* Spacings that the fastest rock and the fastest deposits may lose in a step before it is cut into parts. A deposit that goes
 * comes to rest elsewhere once in each, so that no part may be longer than a deposit's life. */
static const double ROCK_STEP = 1.5, LOOSE_STEP = 0.7;

/* The same of rock where groundwater seeps: what is left of a step goes on into what is around, wet or not. */
static const double SEEPING_STEP = 0.35;

/* Of the time in which a floor would come down to those below it, did they not go on. */
static const double SLOPE_STEP = 1;

/* Spacings that rock may lose before its stress is solved anew, where a step is cut into parts. Deposits may go on. */
static const double STRESS_STEP = 0.5;

/* Landings in a step at most, for what finds no room at once, or slides and slides again; of so many deposits one may still slide
 * after it. */
enum { LANDINGS = 200, FEW_OF = 400 };

/* ---- a frame */

/* What the particles are now; where the others went is counted as they go. */
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

/* Does what erodes in this frame stay in the domain? */
static bool depositing(const struct arenite *a)
{
    return a->deposits && curve_at(&a->m.job->deposition.viability, a->m.frame) > 0;
}

static void weigh(struct arenite *a, enum process process, bool after)
{
    model_weigh(&a->m, process, after, a->particles.field[ROCK_viability], a->particles.n);
}

static status find_surface(struct arenite *a)
{
    status st = OK;
    gpu_stage(a->m.gpu, "surface");
    TRY(arenite_bear(a, DUE_NEAR, 0));
    TRY(particles_surface(a->m.gpu, a->m.work, &a->particles));
done:
    return st;
}

/* Where water, and what breaks off, runs over the shape as it is. `step`: of the frame, for random numbers. */
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
    weigh(a, PROCESS_DEPOSITION, false);
    TRY(deposit_land(a->m.gpu, a->m.work, &a->deposit, a->m.job, a->m.frame, step, &routing, &a->particles,
                     last, moved));
    weigh(a, PROCESS_DEPOSITION, true);
    a->m.ledger.left += moved->left;
    gpu_stage(a->m.gpu, "particles");
    if (moved->waiting)
        TRY(particles_index_waiting(a->m.gpu, a->m.work, &a->particles));
    else if (moved->fragments)
        TRY(particles_index(a->m.gpu, a->m.work, &a->particles));
done:
    return st;
}

/* The same, and what waits or slides goes on until it is at rest, however long the step; a few that keep each other moving slide
 * on in later steps. */
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

/* Eroded particles, in a step of the frame, leave, or come to rest elsewhere. Did anything move? */
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

/* What stands on the ground. What does not has all of its particles after this; what has eroded is still among them. */
static status find_blocks(struct arenite *a)
{
    status st = OK;
    size_t n_cut;
    TRY(blocks_find(a->m.gpu, a->m.work, &a->blocks, &a->particles, &n_cut));
    if (n_cut) {
        TRY(arenite_bear(a, DUE_CHOSEN, n_cut));
        TRY(blocks_find(a->m.gpu, a->m.work, &a->blocks, &a->particles, &n_cut));
    }
done:
    return st;
}

/* What breaks off and is too small to fall as a block goes the way of what eroded. */
static status crumble(struct arenite *a, uint32_t *n_eroded)
{
    status st = OK;
    uint32_t n_crumbs;
    size_t n_loose;
    if (!a->collapse.falls || *n_eroded == 0)
        return OK;
    gpu_stage(a->m.gpu, "blocks");
    TRY(find_blocks(a));
    weigh(a, PROCESS_BLOCKS, false);
    TRY(collapse_crumble(a->m.gpu, a->m.work, &a->collapse, &a->blocks, &a->particles, &n_crumbs, &n_loose));
    weigh(a, PROCESS_BLOCKS, true);
    *n_eroded += n_crumbs;
done:
    return st;
}

status arenite_unsupported(struct arenite *a)
{
    status st = OK;
    uint32_t n_fallen = 0;
    gpu_stage(a->m.gpu, "blocks");
    TRY(find_blocks(a));
    weigh(a, PROCESS_BLOCKS, false);
    if (a->collapse.falls) {
        TRY(collapse_blocks(a->m.gpu, a->m.work, &a->collapse, &a->blocks, &a->particles, &a->m.ledger));
        weigh(a, PROCESS_BLOCKS, true);
        goto done;
    }
    TRY(blocks_fall(a->m.gpu, a->m.work, &a->blocks, &a->particles, &n_fallen));
    a->m.ledger.fallen += n_fallen;
    if (n_fallen) {
        TRY(particles_index(a->m.gpu, a->m.work, &a->particles));
        TRY(arenite_count(a));
    }
    weigh(a, PROCESS_BLOCKS, true);
done:
    return st;
}

/* Stress by the job's solver. The displacement is a resumed run's already: `solved`. */
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

/* Erodibility, from stress, and less what roots hold. */
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

status arenite_age_before(struct arenite *a)
{
    status st = OK;
    TRY(find_surface(a));
    skin_begin(a->m.gpu, a->m.job, &a->particles);
done:
    return st;
}

/* What follows from the shape: surface, normals, stress, erodibility. Rock in motion has its stress. */
status arenite_settle(struct arenite *a, bool solved)
{
    status st = OK;
    TRY(find_surface(a));
    gpu_stage(a->m.gpu, "stress");
    if (!arenite_rests(a->m.job))
        TRY(elastic_clear(a->m.gpu, &a->elastic));
    if (!a->collapse.shot)
        TRY(solve(a, solved));
    if (a->elastic.iterations >= a->elastic.options.max_iterations)
        log_warn(
            "frame %d: stress stopped after %d iterations with an error of %.2g (stress.max_iterations, stress.tolerance %.2g)",
            a->m.frame, a->elastic.iterations, a->elastic.error, a->elastic.options.tolerance);
    TRY(find_rates(a));
done:
    return st;
}

/* The longest step in which neither rock nor deposits lose more than they may, and no floor passes by those below it, kyr. */
static double longest(const struct arenite *a, const struct erosion_pace *pace)
{
    const double rock = a->seeps ? SEEPING_STEP : ROCK_STEP;
    const double moved = fmin(rock / fmax(pace->rock, 1e-30), LOOSE_STEP / fmax(pace->loose, 1e-30));
    return fmin(a->m.h * moved, SLOPE_STEP / fmax(pace->slopes, 1e-30));
}

/* One of the equal parts of so many kyr that are no longer than `most`; but of no more of them than `least` goes into it. */
static double part_of(double kyr, double least, double most)
{
    return kyr > most ? kyr / ceil(kyr / fmax(least, most) - 1e-6) : kyr;
}

/* Where water, and what breaks off, runs in a step, and what water cuts, and how fast its `slopes` change. */
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

/* A frame's edits: what they set and what they do to the rock. */
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
            log_info("frame %d: an edit of the rock makes all of its %zu particles", a->m.frame,
                     a->particles.n + a->particles.n_deep);
        TRY(arenite_bear(a, DUE_ALL, 0));
        weigh(a, PROCESS_EDITS, false);
        TRY(particles_download(a->m.gpu, &a->particles, STATE, &rock));
        TRY(edits_apply(a->m.whole, a->m.frame, &rock, &a->m.ledger, &a->m.start_volume));
        arenite_destroy_particles(a);
        TRY(arenite_create_particles(a, &rock));
        weigh(a, PROCESS_EDITS, true);
        TRY(arenite_count(a));
        if (!a->collapse.shot)
            TRY(arenite_unsupported(a));
    }
    if (a->collapse.shot) /* from here on */
        TRY(collapse_load(a->m.gpu, &a->collapse, &a->particles));
    TRY(arenite_settle(a, false));
done:
    rock_free(&rock);
    return st;
}

/* What is to come of a step, kyr; and how far rock has gone since its stress was solved, spacings. */
struct step {
    double whole, left, moved;
    double from; /* kyr since the first frame, when it began */
};

/* Wind and water on the surface, and the part of a step in which nothing goes too far under them, kyr. */
static status press(struct arenite *a, int number, const struct step *s, struct erosion_pace *pace,
                    double *kyr)
{
    status st = OK;
    const struct job *job = a->m.job;
    struct gpu_buffer *slopes = a->particles.taken;
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
    TRY(erosion_pace(a->m.gpu, a->m.work, &a->erosion, &a->particles, slopes, pace));
    *kyr = part_of(s->left, s->whole / (double)job->erosion.parts, longest(a, pace));
    if (a->plants)
        plants_shield(a->m.gpu, job, &a->particles, a->erosion.intensity);
    if (a->exposed)
        skin_age(a->m.gpu, &a->skin, job, *kyr, a->erosion.intensity, &a->particles);
done:
    return st;
}

/* A part of a step. Stress is solved anew at the step's end, and where rock has gone far or has fallen. */
static status erode(struct arenite *a, int number, struct step *s)
{
    status st = OK;
    struct erosion_pace pace;
    double kyr;
    uint32_t n_eroded;
    bool changed;
    const uint64_t fallen = a->m.ledger.fallen;
    TRY(press(a, number, s, &pace, &kyr));
    gpu_stage(a->m.gpu, "viability");
    TRY(erosion_weather(a->m.gpu, a->m.work, &a->erosion, kyr, &a->particles, a->skin.crust, &a->m.budget,
                        &n_eroded, &a->beyond));
    TRY(crumble(a, &n_eroded));
    if (a->exposed)
        skin_forget(a->m.gpu, &a->particles);
    TRY(remove_eroded(a, number, n_eroded, &changed));
    if (changed)
        TRY(arenite_unsupported(a));
    s->left -= kyr;
    s->moved += pace.rock * kyr / a->m.h;
    if (s->left <= 0 || s->moved > STRESS_STEP || a->m.ledger.fallen != fallen) {
        TRY(arenite_settle(a, false));
        s->moved = 0;
    } else {
        TRY(find_surface(a));
        TRY(find_rates(a));
    }
done:
    return st;
}

/* The frame's years of wind, water and plants. */
static status weather(struct arenite *a)
{
    status st = OK;
    const struct job *job = a->m.job;
    const int steps = erosion_steps(job, wind_fastest(job, a->m.frame));
    const double whole = job->clock.years_per_frame / 1000 / steps;
    const double began = job_years(a->m.whole, a->m.whole->frames.first, a->m.frame - 1) / 1000;
    int number = 0;
    if (a->plants) {
        gpu_stage(a->m.gpu, "plants");
        plants_grow(a->m.gpu, job, a->m.frame, &a->particles);
    }
    for (int i = 0; i < steps; i++)
        for (struct step s = {whole, whole, 0, began + i * whole}; s.left > 0 && a->particles.n > 0;)
            TRY(erode(a, number++, &s));
    if (a->beyond >= pow(a->m.h, 3)) {
        log_warn(
            "frame %d: %.3g m3 more would have gone of rock that a part of a step may not reach, more than %u spacings inside: lower erosion.max_step (%g), or raise erosion.parts (%d)",
            a->m.frame, a->beyond, (unsigned)NEAR_REACH, job->erosion.max_step, (int)job->erosion.parts);
        a->beyond = 0;
    }
done:
    return st;
}

/* The frame's seconds of falling rock. */
static status fall(struct arenite *a)
{
    status st = OK;
    gpu_stage(a->m.gpu, "collapse");
    weigh(a, PROCESS_COLLAPSE, false);
    TRY(collapse_frame(a->m.gpu, a->m.work, &a->collapse, a->m.job->clock.seconds_per_frame, &a->particles,
                       &a->m.ledger));
    weigh(a, PROCESS_COLLAPSE, true);
    TRY(arenite_settle(a, false));
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

/* Volume, and the largest stress at the surface. */
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

/* The same of a frame without its particles: what is measured comes over alone. */
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

/* The discharge over the shape as it is now. One grid and one set of choices for all frames, so that streams
 * move only where the rock has changed. */
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
    if (wants.points || wants.volumes || wants.pictures)
        TRY(show_water(a));
    gpu_stage(m->gpu, "field");
    m->field.whole = !arenite_rests(m->job);
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
        TRY(field_download(m->gpu, &m->field, &a->particles, has, &out->grids));
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
};
