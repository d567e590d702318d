/* Goblins: sandstone that weathers where bubbles hold air (Beardall et al. 2007).
 *
 * One frame:
 *
 *   rates -> cycles (pace, decimate, apply, touch, skin, list, count) until the frame's years have passed
 *         -> unsupported blocks -> ledger
 *
 * output() then hands the voxels on as particles, one each, to the surface field, the stress solver and the
 * pictures. The state between frames is what is left of each voxel, its factor, and the ledger; air in
 * bubbles is counted anew when a run is continued, and comes out the same.
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/log.h"
#include "base/memory.h"
#include "blocks/blocks.h"
#include "frame/host.h"
#include "geology/attitude.h"
#include "model/inside.h"
#include "model/sections.h"
#include "model/type.h"
#include "particles/particles.h"
#include "scene/scene.h"
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

static void weigh(struct goblins *g, enum process process, bool after)
{
    model_weigh(&g->m, process, after, g->voxels.left, gpu_buffer_count(g->voxels.left));
}

static status remove_unsupported(struct goblins *g)
{
    status st = OK;
    uint32_t n_fallen = 0;
    if (g->m.job->goblins.floats)
        return OK;
    gpu_stage(g->m.gpu, "blocks");
    weigh(g, PROCESS_BLOCKS, false);
    voxels_solid(g->m.gpu, &g->voxels, g->blocks.solid);
    TRY(blocks_join(g->m.gpu, g->m.work, &g->blocks, &g->held));
    TRY(voxels_fall(g->m.gpu, g->m.work, &g->voxels, g->blocks.solid, g->blocks.pointer, g->blocks.other));
    TRY(voxels_remove(g->m.gpu, g->m.work, &g->voxels, &n_fallen));
    weigh(g, PROCESS_BLOCKS, true);
    g->m.ledger.rock -= n_fallen;
    g->m.ledger.fallen += n_fallen;
done:
    return st;
}

static status step(struct model *m)
{
    status st = OK;
    struct goblins *g = of(m);
    double kyr = m->job->clock.years_per_frame / 1000;
    gpu_stage(m->gpu, "weathering");
    weigh(g, PROCESS_WEATHERING, false);
    TRY(voxels_rates(m->gpu, &g->voxels, m->job, m->frame));
    while (kyr > 0 && m->ledger.rock > 0) {
        double passed;
        uint32_t n_gone;
        TRY(voxels_cycle(m->gpu, m->work, &g->voxels, m->job->goblins.quantum, kyr, &passed, &n_gone));
        kyr -= passed;
        m->ledger.rock -= n_gone;
        m->ledger.left += n_gone;
    }
    weigh(g, PROCESS_WEATHERING, true);
    TRY(remove_unsupported(g));
done:
    return st;
}

/* ---- what a frame shows */

static double volume_of(const struct model *m, const float *share)
{
    return model_sum(share, voxel_count(m->voxels)) * m->h * m->h * m->h;
}

/* One particle for each voxel that is left, in its middle, with the voxel's number as its id. */
static status rock_of(const struct goblins *g, const float *share, const float *factor, struct rock *rock)
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
                const double rate = curve_at(&g->m.job->strata[layer].weak_m_per_kyr, g->m.frame);
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

/* Stress from rest: nothing of it is handed from frame to frame, so that a continued run has the same. */
static status settle(struct goblins *g, struct particles *p)
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
    if (job->goblins.stress) {
        TRY(settle(g, p));
        out->stress_iterations = g->elastic.iterations;
    }
    gpu_stage(g->m.gpu, "field");
    if (wants.volumes || wants.pictures)
        TRY(field_build(g->m.gpu, g->m.work, &g->m.field, p, 0));
    if (wants.points)
        TRY(particles_download(g->m.gpu, p, DERIVED, &out->rock));
    if (wants.volumes) {
        TRY(field_download(g->m.gpu, &g->m.field, p, HAS_ALWAYS, &out->grids));
        TRY(inside_values(g->m.gpu, &g->elastic, &out->grids));
    }
    if (wants.pictures) {
        gpu_stage(g->m.gpu, "pictures");
        TRY(aov_render_all(g->m.gpu, &g->m.aov, job, &g->m.field, p, NULL, out));
    }
done:
    return st;
}

static status output(struct model *m, struct frame *out)
{
    status st = OK;
    struct goblins *g = of(m);
    const struct frame_wants wants = model_wants(m);
    size_t n = voxel_count(m->voxels);
    float *share = NULL, *factor = NULL;
    struct rock rock = {0};
    struct particles p = {0};
    gpu_stage(m->gpu, "surface");
    TRY(memory_alloc(n, sizeof *share, "voxels", &share));
    TRY(memory_alloc(n, sizeof *factor, "voxels", &factor));
    TRY(voxels_download(m->gpu, &g->voxels, share, factor));
    out->volume_m3 = volume_of(m, share);
    if (!wants.points && !wants.volumes && !wants.pictures)
        goto done;
    TRY(rock_of(g, share, factor, &rock));
    TRY(particles_create(m->gpu, m->work, &rock, STATE, m->voxels, m->h, &p));
    p.walls = job_walls(m->job);
    m->shown = &p;
    TRY(gpu_upload(m->gpu, p.field[ROCK_erodibility], 0, rock.erodibility, rock.n));
    TRY(show(g, wants, &p, out));
done:
    free(share);
    free(factor);
    rock_free(&rock);
    m->shown = NULL;
    particles_destroy(m->gpu, &p);
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

enum { HALF_MAX = 65504 }; /* factors are kept as halves */

/* Voxels with something left of them. */
static size_t count(const float *share, size_t n)
{
    size_t sum = 0;
    for (size_t i = 0; i < n; i++)
        sum += share[i] > VOXELS_SLIVER;
    return sum;
}

static status restore(struct model *m, const struct checkpoint *c)
{
    status st = OK;
    const size_t n = voxel_count(m->voxels);
    size_t n_rock;
    const void *share, *factor;
    TRY(section_take(c, &(struct section_rule){"voxels", SECTION_FLOAT, n, 1, {{0, 1}}}, &share, NULL));
    TRY(section_take(c, &(struct section_rule){"factors", SECTION_FLOAT, n, 1, {{0, HALF_MAX}}}, &factor,
                     NULL));
    /* Frames have as many particles as the ledger has rock. */
    n_rock = count(share, n);
    if (m->ledger.rock != n_rock || m->ledger.deposit != 0)
        return fail(
            E_CHECKPOINT,
            "the checkpoint of frame %d is damaged: section 'ledger' counts %llu voxels of rock and %llu deposited, and section 'voxels' has %zu",
            c->frame, (unsigned long long)m->ledger.rock, (unsigned long long)m->ledger.deposit, n_rock);
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
    TRY(voxels_create(m->gpu, m->work, m->job, m->voxels, share, factor, &g->voxels));
    m->ledger.start = m->ledger.rock = count(share, n);
    const double lowest = lowest_of(m, share);
    TRY(remove_unsupported(g));
    TRY(voxels_download(m->gpu, &g->voxels, share, NULL));
    TRY(model_check_stands(m, lowest, lowest_of(m, share) < HUGE_VAL));
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
    const struct elastic_options options = elastic_options(m->job, NULL);
    TRY(held_create(m->gpu, m->voxels, voxel_count(m->voxels), &g->held));
    TRY(held_all(m->gpu, m->work, &g->held));
    TRY(blocks_create(m->gpu, g->held.n, NULL, &g->blocks));
    if (m->job->goblins.stress)
        TRY(elastic_create(m->gpu, m->voxels, m->h, &options, &g->elastic));
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

static size_t work_items(const struct job *job, const int voxels[3])
{
    const size_t stress = elastic_work_items(voxels), each = voxel_count(voxels) + 2;
    size_t words, items = each > stress ? each : stress;
    voxels_bytes(job, voxels, 0, &words);
    return words > items ? words : items;
}

/* Cycles, about: a voxel's retreat takes four of them at a quantum of one half. */
static double cycles(const struct job *job)
{
    double most = 0;
    for (size_t i = 0; i < job->n_strata; i++)
        most = fmax(most, curve_max(&job->strata[i].weak_m_per_kyr));
    return (double)(job->frames.last - job->frames.first) *
           (1 + job->clock.years_per_frame / 1000 * most / job->domain.spacing_m * 2 /
                    fmax(job->goblins.quantum, 0.05));
}

static status estimate(const struct job *job, struct model_needs *needs)
{
    status st = OK;
    /* Voxels' middles are a lattice, which packs well. */
    static const struct disk_particle
        bare = {.inside = 3, .bare = 18, .volumes_inside = 1.5, .volumes_bare = 50, .channel = 1.5},
        stressed = {.inside = 10.6, .bare = 35, .volumes_inside = 2.2, .volumes_bare = 110, .channel = 1.9};
    const uint64_t state = 8 * (uint64_t)voxel_count(needs->voxels);
    size_t words;
    TRY(scene_estimate(job, &needs->size));
    /* A third of the rock active is more than most have. */
    needs->room = needs->size.n_particles;
    needs->device_bytes = voxels_bytes(job, needs->voxels, needs->size.n_particles / 3, &words) +
                          blocks_bytes(voxel_count(needs->voxels)) +
                          held_bytes(needs->voxels, voxel_count(needs->voxels)) +
                          (job->goblins.stress ? elastic_bytes(needs->voxels, needs->size.n_particles,
                                                               needs->size.n_surface, needs->size.n_ends)
                                               : 0);
    /* What frames are made from: the voxels, and as particles. */
    needs->host_bytes = state + host_rock_bytes(needs->size.n_particles);
    needs->samples = host_grid_samples(needs->voxels, needs->size.n_particles, needs->size.n_surface);
    needs->disk = job->goblins.stress ? stressed : bare;
    needs->checkpoint_bytes = (uint64_t)(0.1 * (double)state);
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
};
