/* Goblins: sandstone as voxels that weather in proportion to the air in a bubble around them (Beardall et al. 2007).
 *
 * One frame is a list of stages (gpu_stage()):
 *
 *   edits         edit()                   what the frame's edits set, carve, add and paint
 *   weathering    voxels_rates(); then voxels_cycle() until the frame's years have passed
 *   blocks        remove_unsupported()
 *
 * output() then makes one particle of each voxel and adds the stages surface, stress, field and pictures.
 *
 * The state between frames consists of the share that is left of each voxel, its rate factor, and the ledger. The air in bubbles is
 * counted again when a run is continued, with the same result.
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/log.h"
#include "base/memory.h"
#include "blocks/blocks.h"
#include "frame/host.h"
#include "geology/attitude.h"
#include "model/edits.h"
#include "model/goblins.h"
#include "model/inside.h"
#include "model/sections.h"
#include "model/type.h"
#include "particles/particles.h"
#include "scene/scene.h"
#include "shape/voxel_file.h"
#include "stress/elastic.h"
#include "voxels/support.h"
#include "voxels/voxels.h"

struct goblins {
    struct model m; /* shared by all models */
    struct voxels voxels;
    struct held_voxels held; /* all voxels, for the blocks */
    struct blocks blocks;
    struct elastic elastic;
};

static struct goblins *of(struct model *m)
{
    return (struct goblins *)m;
}

/* ---- a frame */

static void budget_before(struct goblins *g, enum process process)
{
    model_budget_before(&g->m, process, g->voxels.left, gpu_buffer_count(g->voxels.left));
}

static void budget_after(struct goblins *g, enum process process)
{
    model_budget_after(&g->m, process, g->voxels.left, gpu_buffer_count(g->voxels.left));
}

static status remove_unsupported(struct goblins *g)
{
    status st = OK;
    uint32_t n_fallen = 0;
    if (g->m.job->goblins.floats)
        return OK;
    gpu_stage(g->m.gpu, "blocks");
    budget_before(g, PROCESS_BLOCKS);
    voxels_solid(g->m.gpu, &g->voxels, g->blocks.solid);
    TRY(blocks_join(g->m.gpu, g->m.work, &g->blocks, &g->held));
    TRY(voxels_fall(g->m.gpu, g->m.work, &g->voxels, g->blocks.solid, g->blocks.pointer, g->blocks.other));
    TRY(voxels_remove(g->m.gpu, g->m.work, &g->voxels, &n_fallen));
    budget_after(g, PROCESS_BLOCKS);
    g->m.ledger.rock -= n_fallen;
    g->m.ledger.fallen += n_fallen;
done:
    return st;
}

/* ---- edits */

/* The number of voxels of which something is left. */
static size_t count(const float *share, size_t n)
{
    size_t sum = 0;
    for (size_t i = 0; i < n; i++)
        sum += share[i] > VOXELS_SLIVER;
    return sum;
}

/* Makes one particle at the centre of each voxel that is left, with the voxel's number as its id. */
static status make_rock(const struct goblins *g, const float *share, const float *factor, struct rock *rock)
{
    status st = OK;
    const int *n = g->m.voxels;
    size_t i = 0, v = 0;
    TRY(rock_alloc(rock, g->m.ledger.rock, DERIVED));
    for (int z = 0; z < n[2]; z++) {
        for (int y = 0; y < n[1]; y++)
            for (int x = 0; x < n[0]; x++, v++) {
                if (share[v] <= 0)
                    continue;
                const double at[3] = {(x + 0.5) * g->m.h, (y + 0.5) * g->m.h, (z + 0.5) * g->m.h};
                const size_t layer = attitude_layer(g->m.job, at);
                const double rate = job_weak(g->m.job, layer, g->m.frame);
                for (int a = 0; a < 3; a++)
                    rock->P[4 * i + (size_t)a] = (float)at[a];
                rock->id[i] = (uint32_t)v;
                rock->viability[i] = share[v];
                rock->layer[i] = (uint32_t)layer;
                rock->rate_factor[i] = factor[v];
                rock->interlock_factor[i] = 1;
                rock->erodibility[i++] = (float)(rate * (double)factor[v]);
            }
    }
done:
    return st;
}

/* What the frame's edits carve, add and paint, on arrays as of voxels_create(). */
static status edit_rock(struct goblins *g, float *share, float *factor)
{
    status st = OK;
    struct model *m = &g->m;
    struct rock rock = {0};
    if (edits_of(m->whole, m->frame) != EDITS_ROCK)
        return OK;
    TRY(make_rock(g, share, factor, &rock));
    TRY(edits_apply(m->whole, m->frame, &rock, &m->ledger, &m->start_volume));
    memset(share, 0, voxel_count(m->voxels) * sizeof *share);
    for (size_t p = 0; p < rock.n; p++) {
        size_t v = 0;
        for (size_t a = 3; a-- > 0;)
            v = v * (size_t)m->voxels[a] + (size_t)((double)rock.P[4 * p + a] / m->h);
        share[v] = rock.viability[p];
        factor[v] = rock.rate_factor[p];
    }
    m->ledger.rock = rock.n;
done:
    rock_free(&rock);
    return st;
}

static bool shows_stress(const struct job *job)
{
    return job->goblins.stress;
}

static status create_stress(struct goblins *g)
{
    const struct elastic_options options = elastic_options(g->m.job, NULL);
    return shows_stress(g->m.job) ? elastic_create(g->m.gpu, g->m.voxels, g->m.h, &options, &g->elastic) : OK;
}

/* Applies the frame's edits: the keys that they set, and what they carve, add and paint. */
static status edit(struct goblins *g)
{
    status st = OK;
    struct model *m = &g->m;
    const size_t n = voxel_count(m->voxels);
    float *share = NULL, *factor = NULL;
    if (edits_of(m->whole, m->frame) == EDITS_NONE)
        return OK;
    gpu_stage(m->gpu, "edits");
    TRY(memory_alloc(n, sizeof *share, "voxels", &share));
    TRY(memory_alloc(n, sizeof *factor, "voxels", &factor));
    budget_before(g, PROCESS_EDITS);
    TRY(voxels_download(m->gpu, &g->voxels, share, factor));
    TRY(edit_rock(g, share, factor));
    voxels_destroy(m->gpu, &g->voxels);
    TRY(voxels_create(m->gpu, m->work, m->job, m->voxels, share, factor, &g->voxels));
    budget_after(g, PROCESS_EDITS);
    elastic_destroy(m->gpu, &g->elastic);
    TRY(create_stress(g));
    TRY(remove_unsupported(g));
done:
    free(share);
    free(factor);
    return st;
}

static status step(struct model *m)
{
    status st = OK;
    struct goblins *g = of(m);
    double kyr = m->job->clock.years_per_frame / 1000;
    TRY(edit(g));
    gpu_stage(m->gpu, "weathering");
    budget_before(g, PROCESS_WEATHERING);
    TRY(voxels_rates(m->gpu, &g->voxels, m->job, m->frame));
    while (kyr > 0 && m->ledger.rock > 0) {
        double passed;
        uint32_t n_gone;
        TRY(voxels_cycle(m->gpu, m->work, &g->voxels, m->job->goblins.quantum, kyr, &passed, &n_gone));
        kyr -= passed;
        m->ledger.rock -= n_gone;
        m->ledger.left += n_gone;
    }
    budget_after(g, PROCESS_WEATHERING);
    TRY(remove_unsupported(g));
done:
    return st;
}

/* ---- what a frame shows */

static double volume_of(const struct model *m, const float *share)
{
    return model_sum(share, voxel_count(m->voxels)) * m->h * m->h * m->h;
}

/* Solves the stress from zero displacement: none is kept between frames, so that a continued run has the same stress. */
static status solve_stress(struct goblins *g, struct particles *p)
{
    status st = OK;
    gpu_stage(g->m.gpu, "stress");
    gpu_fill(g->m.gpu, g->elastic.u, 0);
    TRY(elastic_assemble(g->m.gpu, g->m.work, &g->elastic, p));
    TRY(elastic_solve(g->m.gpu, g->m.work, &g->elastic));
    elastic_recover(g->m.gpu, &g->elastic, p);
done:
    return st;
}

static status show(struct goblins *g, struct frame_wants wants, struct particles *p, struct frame *out)
{
    status st = OK;
    const struct job *job = g->m.job;
    gpu_stage(g->m.gpu, "surface");
    TRY(particles_surface(g->m.gpu, g->m.work, p));
    if (shows_stress(job)) {
        TRY(solve_stress(g, p));
        out->stress_iterations = g->elastic.iterations;
    }
    gpu_stage(g->m.gpu, "field");
    if (wants.volumes || wants.pictures)
        TRY(field_build(g->m.gpu, g->m.work, &g->m.field, p, 0));
    if (wants.points)
        TRY(particles_download(g->m.gpu, p, DERIVED, &out->rock));
    if (wants.volumes) {
        TRY(model_grids(&g->m, HAS_ALWAYS, &out->grids));
        TRY(inside_values(g->m.gpu, &g->elastic, &out->grids));
    }
    if (wants.pictures) {
        gpu_stage(g->m.gpu, "pictures");
        TRY(aov_render_all(g->m.gpu, &g->m.aov, job, &g->m.field, p, NULL, out));
    }
done:
    return st;
}

static bool wants_voxels(const struct job *job, int frame)
{
    return job->goblins.voxels == VOXELS_ALL ||
           (job->goblins.voxels == VOXELS_LAST && frame == job->frames.last);
}

static status output(struct model *m, struct frame *out)
{
    status st = OK;
    struct goblins *g = of(m);
    const struct frame_wants wants = model_wants(m);
    size_t n = voxel_count(m->voxels);
    float *share = NULL, *factor = NULL;
    struct rock rock = {0};
    gpu_stage(m->gpu, "surface");
    TRY(memory_alloc(n, sizeof *share, "voxels", &share));
    TRY(memory_alloc(n, sizeof *factor, "voxels", &factor));
    TRY(voxels_download(m->gpu, &g->voxels, share, factor));
    out->volume_m3 = volume_of(m, share);
    if (m->makes == MAKES_FILES && wants_voxels(m->job, m->frame))
        TRY(voxel_file_encode(m->voxels, m->h, share, &out->voxels.bytes, &out->voxels.size));
    if (!wants.points && !wants.volumes && !wants.pictures)
        goto done;
    TRY(make_rock(g, share, factor, &rock));
    TRY(particles_create(m->gpu, m->work, &rock, STATE, m->voxels, m->h, &m->made));
    m->made.walls = job_walls(m->job);
    m->shown = &m->made;
    TRY(gpu_upload(m->gpu, m->made.field[ROCK_erodibility], 0, rock.erodibility, rock.n));
    TRY(show(g, wants, &m->made, out));
done:
    free(share);
    free(factor);
    rock_free(&rock);
    return st;
}

static void watch(const struct model *m, struct watch_list *list)
{
    const struct goblins *g = (const struct goblins *)m;
    const struct elastic *e = &g->elastic;
    watch_add(list, "what is left of voxels", g->voxels.left,
              g->voxels.left ? gpu_buffer_count(g->voxels.left) : 0);
    if (e->u && watch_between(list, "stress", "stress"))
        watch_add(list, "displacement", e->u, gpu_buffer_count(e->u));
}

/* ---- the state */

static status save(struct model *m, struct checkpoint *out)
{
    status st = OK;
    void *share, *factor;
    TRY(section_add(out, "voxels", 4, voxel_count(m->voxels), &share));
    TRY(section_add(out, "factors", 4, voxel_count(m->voxels), &factor));
    TRY(voxels_download(m->gpu, &of(m)->voxels, share, factor));
    TRY(sections_add_counts(out, m));
done:
    return st;
}

enum { HALF_MAX = 65504 }; /* factors are stored as halves */

status goblins_read(const struct checkpoint *c, const int voxels[3], const struct ledger *ledger,
                    const float **share, const float **factor)
{
    status st = OK;
    const size_t n = voxel_count(voxels);
    size_t n_rock;
    const void *shares, *factors;
    TRY(section_get(c, &(struct section_rule){"voxels", SECTION_FLOAT, n, 1, {{0, 1}}}, &shares, NULL));
    TRY(section_get(c, &(struct section_rule){"factors", SECTION_FLOAT, n, 1, {{0, HALF_MAX}}}, &factors,
                    NULL));
    /* Frames have one particle for each voxel that the ledger counts as rock. */
    n_rock = count(shares, n);
    if (ledger->rock != n_rock || ledger->deposit != 0)
        return fail(
            E_CHECKPOINT,
            "the checkpoint of frame %d is damaged: section 'ledger' counts %llu voxels of rock and %llu deposited, but section 'voxels' has %zu voxels of rock",
            c->frame, (unsigned long long)ledger->rock, (unsigned long long)ledger->deposit, n_rock);
    *share = shares;
    *factor = factors;
done:
    return st;
}

static status restore(struct model *m, const struct checkpoint *c)
{
    status st = OK;
    const float *share, *factor;
    TRY(goblins_read(c, m->voxels, &m->ledger, &share, &factor));
    TRY(voxels_create(m->gpu, m->work, m->job, m->voxels, share, factor, &of(m)->voxels));
done:
    return st;
}

/* The foot of the lowest voxel that is at least half rock, m; HUGE_VAL: there is none. */
static double lowest_of(const struct model *m, const float *share)
{
    const size_t slab = (size_t)m->voxels[0] * (size_t)m->voxels[1];
    for (size_t i = 0; i < voxel_count(m->voxels); i++)
        if (share[i] >= 0.5f)
            return (double)(i / slab) * m->h;
    return HUGE_VAL;
}

static status begin(struct model *m)
{
    status st = OK;
    struct goblins *g = of(m);
    const size_t n = voxel_count(m->voxels);
    float *share = NULL, *factor = NULL;
    TRY(memory_alloc(n, sizeof *share, "voxels", &share));
    TRY(memory_alloc(n, sizeof *factor, "voxels", &factor));
    TRY(scene_grid(m->job, m->job->goblins.floats, share, factor));
    m->ledger.start = m->ledger.rock = count(share, n);
    TRY(edit_rock(g, share, factor));
    TRY(voxels_create(m->gpu, m->work, m->job, m->voxels, share, factor, &g->voxels));
    const double lowest = lowest_of(m, share);
    TRY(remove_unsupported(g));
    TRY(voxels_download(m->gpu, &g->voxels, share, NULL));
    TRY(model_check_supported(m, lowest, lowest_of(m, share) < HUGE_VAL));
    m->start_volume = volume_of(m, share);
done:
    free(share);
    free(factor);
    return st;
}

static status create(struct model *m)
{
    status st = OK;
    struct goblins *g = of(m);
    TRY(held_create(m->gpu, m->voxels, voxel_count(m->voxels), &g->held));
    TRY(held_all(m->gpu, m->work, &g->held));
    TRY(blocks_create(m->gpu, g->held.n, NULL, &g->blocks));
    TRY(create_stress(g));
    TRY(scene_edits_check(m->whole, m->frame));
    for (size_t i = 0; i < m->whole->n_edits; i++)
        if (m->whole->edits[i].set.job)
            TRY(voxels_check(m->whole->edits[i].set.job));
done:
    return st;
}

static void destroy(struct model *m)
{
    struct goblins *g = of(m);
    elastic_destroy(m->gpu, &g->elastic);
    blocks_destroy(m->gpu, &g->blocks);
    held_destroy(m->gpu, &g->held);
    voxels_destroy(m->gpu, &g->voxels);
}

/* ---- what a job takes */

/* The most bytes that the voxels take, with n active ones, for the job and after each of its edits; *words as of voxels_bytes(). */
static uint64_t most_bytes(const struct job *job, const int voxels[3], size_t n, size_t *words)
{
    uint64_t most = voxels_bytes(job, voxels, n, words);
    for (size_t i = 0; i < job->n_edits; i++) {
        size_t then_words;
        if (!job->edits[i].set.job)
            continue;
        const uint64_t then = voxels_bytes(job->edits[i].set.job, voxels, n, &then_words);
        most = then > most ? then : most;
        *words = then_words > *words ? then_words : *words;
    }
    return most;
}

static size_t work_items(const struct job *job, const int voxels[3])
{
    const size_t stress = elastic_work_items(voxels), each = voxel_count(voxels) + 2;
    size_t words, items = each > stress ? each : stress;
    most_bytes(job, voxels, 0, &words);
    return words > items ? words : items;
}

/* About the number of cycles: removing a voxel takes four of them at a quantum of one half. */
static double cycles(const struct job *job)
{
    double most = 0;
    for (size_t i = 0; i < job->n_strata; i++)
        most = fmax(most, curve_max(&job->strata[i].weak_m_per_kyr) * curve_max(&job->strata_scale.rates));
    return (double)(job->frames.last - job->frames.first) *
           (1 + job->clock.years_per_frame / 1000 * most / job->domain.spacing_m * 2 /
                    fmax(job->goblins.quantum, 0.05));
}

static status estimate(const struct job *job, struct model_needs *needs)
{
    status st = OK;
    /* Particles at the centres of voxels form a lattice, which compresses well. */
    static const struct disk_particle
        bare = {.inside = 3, .bare = 18, .volumes_inside = 1.5, .volumes_bare = 50, .channel = 1.5},
        stressed = {.inside = 10.6, .bare = 35, .volumes_inside = 2.2, .volumes_bare = 110, .channel = 1.9};
    const uint64_t state = 8 * (uint64_t)voxel_count(needs->voxels);
    const bool stressed_ever = edits_ever(job, shows_stress);
    size_t words;
    TRY(scene_estimate(job, &needs->size));
    /* Most jobs have less than a third of their rock active. */
    needs->capacity = needs->size.n_particles;
    needs->device_bytes = most_bytes(job, needs->voxels, needs->size.n_particles / 3, &words) +
                          blocks_bytes(voxel_count(needs->voxels)) +
                          held_bytes(needs->voxels, voxel_count(needs->voxels)) +
                          (stressed_ever ? elastic_bytes(needs->voxels, needs->size.n_particles,
                                                         needs->size.n_surface, needs->size.n_ends)
                                         : 0);
    /* Frames are made from the voxels and the particles made of them. */
    needs->host_bytes = state + host_rock_bytes(needs->size.n_particles);
    needs->frame.kept = stressed_ever ? 2 : 0; /* see inside_values() */
    needs->frame.samples = host_grid_samples(needs->voxels, needs->size.n_particles, needs->size.n_surface);
    needs->disk = stressed_ever ? stressed : bare;
    needs->checkpoint_bytes = (uint64_t)(0.1 * (double)state);
    if (job->goblins.voxels ==
        VOXELS_ALL) /* runs of equal voxels, of which the surface has two or three per row that it crosses */
        needs->disk_other = 8 * (uint64_t)needs->size.n_surface;
    needs->steps = cycles(job);
    needs->kernels = 70;
done:
    return st;
}

const struct model_type goblins_type = {
    .size = sizeof(struct goblins),
    .estimate = estimate,
    .work_items = work_items,
    .create = create,
    .begin = begin,
    .restore = restore,
    .destroy = destroy,
    .step = step,
    .watch = watch,
    .output = output,
    .save = save,
    .resample = goblins_resample,
};
