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
#include "erosion/budget.h"
#include "field/aov.h"
#include "field/field.h"
#include "model/model.h"
#include "model/sections.h"
#include "particles/particles.h"
#include "scene/scene.h"
#include "stress/elastic.h"
#include "voxels/support.h"
#include "voxels/voxels.h"

struct model {
    struct gpu *gpu;
    const struct job *job;
    int frame;
    double years;        /* since the first frame */
    double start_volume; /* m3 */
    struct ledger ledger;
    struct budget budget;
    int64_t change[BUDGET_ROWS]; /* quanta, in the last frame */
    struct gpu_work *work;
    struct voxels voxels;
    struct blocks blocks;
    struct elastic elastic;
    struct field field;
    struct aov aov;
};

static size_t voxel_count(const int n[3])
{
    return (size_t)n[0] * (size_t)n[1] * (size_t)n[2];
}

/* ---- a frame */

/* Enters all that the rock has, before and after a process, into the frame's budget. */
static void weigh(struct model *m, uint32_t process, bool after)
{
    budget_sum(m->gpu, &m->budget, process, after, m->voxels.left, gpu_buffer_count(m->voxels.left));
}

static status remove_unsupported(struct model *m)
{
    status st = OK;
    uint32_t n_fallen = 0;
    if (m->job->goblins.floats)
        return OK;
    gpu_stage(m->gpu, "blocks");
    weigh(m, BUDGET_BLOCKS, false);
    voxels_solid(m->gpu, &m->voxels, m->blocks.solid);
    TRY(blocks_join(m->gpu, m->work, &m->blocks, m->voxels.n));
    TRY(voxels_fall(m->gpu, m->work, &m->voxels, m->blocks.solid, m->blocks.pointer, m->blocks.other));
    TRY(voxels_remove(m->gpu, m->work, &m->voxels, &n_fallen));
    weigh(m, BUDGET_BLOCKS, true);
    m->ledger.rock -= n_fallen;
    m->ledger.fallen += n_fallen;
done:
    return st;
}

static status step(struct model *m)
{
    status st = OK;
    double kyr = m->job->clock.years_per_frame / 1000;
    m->frame++;
    m->years += m->job->clock.years_per_frame;
    budget_clear(m->gpu, &m->budget);
    gpu_stage(m->gpu, "weathering");
    weigh(m, BUDGET_WEATHERING, false);
    TRY(voxels_rates(m->gpu, &m->voxels, m->job, m->frame));
    while (kyr > 0 && m->ledger.rock > 0) {
        double passed;
        uint32_t n_gone;
        TRY(voxels_cycle(m->gpu, m->work, &m->voxels, m->job->goblins.quantum, kyr, &passed, &n_gone));
        kyr -= passed;
        m->ledger.rock -= n_gone;
        m->ledger.left += n_gone;
    }
    weigh(m, BUDGET_WEATHERING, true);
    TRY(remove_unsupported(m));
    TRY(budget_read(m->gpu, &m->budget, m->change));
done:
    return st;
}

/* ---- what a frame shows */

static double volume_of(const float *share, size_t n, double h)
{
    double sum = 0;
    for (size_t i = 0; i < n; i++)
        sum += (double)share[i];
    return sum * h * h * h;
}

/* One particle for each voxel that is left, in its middle, with the voxel's number as its id. */
static status rock_of(const struct model *m, const float *share, const float *factor, struct rock *rock)
{
    status st = OK;
    const int *n = m->voxels.n;
    size_t i = 0, v = 0;
    TRY(rock_alloc(rock, m->ledger.rock, DERIVED));
    for (int z = 0; z < n[2]; z++) {
        size_t layer = job_layer_at(m->job, (z + 0.5) * m->voxels.h);
        double rate = curve_at(&m->job->strata[layer].weak_m_per_kyr, m->frame);
        for (int y = 0; y < n[1]; y++)
            for (int x = 0; x < n[0]; x++, v++) {
                if (share[v] <= 0)
                    continue;
                const int at[3] = {x, y, z};
                for (int a = 0; a < 3; a++)
                    rock->P[4 * i + (size_t)a] = (float)((at[a] + 0.5) * m->voxels.h);
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
static status settle(struct model *m, struct particles *p)
{
    status st = OK;
    gpu_stage(m->gpu, "stress");
    gpu_fill(m->gpu, m->elastic.u, 0);
    TRY(elastic_assemble(m->gpu, m->work, &m->elastic, p));
    TRY(elastic_solve(m->gpu, m->work, &m->elastic));
    elastic_recover(m->gpu, &m->elastic, p);
done:
    return st;
}

static status show(struct model *m, struct particles *p, struct frame *out)
{
    status st = OK;
    const struct job *job = m->job;
    gpu_stage(m->gpu, "surface");
    TRY(particles_surface(m->gpu, m->work, p));
    if (job->goblins.stress)
        TRY(settle(m, p));
    gpu_stage(m->gpu, "field");
    field_build(m->gpu, &m->field, p);
    TRY(particles_download(m->gpu, p, DERIVED, &out->rock));
    TRY(field_download(m->gpu, &m->field, p, NULL, 0, &out->grids));
    gpu_stage(m->gpu, "pictures");
    TRY(aov_render_all(m->gpu, &m->aov, job, &m->field, p, NULL, out));
done:
    return st;
}

static status output(struct model *m, struct frame *out)
{
    status st = OK;
    size_t n = voxel_count(m->voxels.n);
    float *share = NULL, *factor = NULL;
    struct rock rock = {0};
    struct particles p = {0};
    *out = (struct frame){
        .number = m->frame, .years = m->years, .ledger = m->ledger, .start_volume_m3 = m->start_volume};
    gpu_stage(m->gpu, "surface");
    TRY(memory_alloc(n, sizeof *share, "voxels", &share));
    TRY(memory_alloc(n, sizeof *factor, "voxels", &factor));
    TRY(voxels_download(m->gpu, &m->voxels, share, factor));
    out->volume_m3 = volume_of(share, n, m->voxels.h);
    for (const uint32_t *row = (const uint32_t[]){BUDGET_WEATHERING, BUDGET_BLOCKS, BUDGET_ROWS};
         *row < BUDGET_ROWS; row++)
        out->change[out->n_changes++] =
            (struct frame_change){budget_names[*row], budget_m3(m->change[*row], m->voxels.h)};
    TRY(rock_of(m, share, factor, &rock));
    TRY(particles_create(m->gpu, m->work, &rock, STATE, m->voxels.n, m->voxels.h, &p));
    TRY(gpu_upload(m->gpu, p.field[ROCK_erodibility], 0, rock.erodibility, rock.n));
    TRY(show(m, &p, out));
    out->stress_iterations = m->elastic.iterations;
done:
    free(share);
    free(factor);
    rock_free(&rock);
    particles_destroy(m->gpu, &p);
    if (st != OK)
        frame_free(out);
    return st;
}

/* ---- the state */

static status save(struct model *m, struct checkpoint *out)
{
    status st = OK;
    void *share, *factor, *data;
    size_t n = voxel_count(m->voxels.n);
    *out = (struct checkpoint){.frame = m->frame, .years = m->years};
    TRY(section_add_domain(out, m->job));
    TRY(section_add(out, "voxels", 4, n, &share));
    TRY(section_add(out, "factors", 4, n, &factor));
    TRY(voxels_download(m->gpu, &m->voxels, share, factor));
    TRY(section_add(out, "ledger", 8, sizeof m->ledger / 8, &data));
    memcpy(data, &m->ledger, sizeof m->ledger);
    TRY(section_add(out, "start volume", 8, 1, &data));
    memcpy(data, &m->start_volume, sizeof m->start_volume);
    TRY(section_add(out, "change", 8, BUDGET_ROWS, &data));
    memcpy(data, m->change, sizeof m->change);
done:
    if (st != OK)
        checkpoint_free(out);
    return st;
}

static status restore(struct model *m, const struct checkpoint *c, const int n[3])
{
    status st = OK;
    const struct checkpoint_section *s, *factor;
    TRY(section_check_domain(c, m->job));
    TRY(section_find(c, "ledger", 8, sizeof m->ledger / 8, &s));
    memcpy(&m->ledger, s->data, sizeof m->ledger);
    TRY(section_find(c, "start volume", 8, 1, &s));
    memcpy(&m->start_volume, s->data, sizeof m->start_volume);
    TRY(section_find(c, "change", 8, BUDGET_ROWS, &s));
    memcpy(m->change, s->data, sizeof m->change);
    TRY(section_find(c, "voxels", 4, voxel_count(n), &s));
    TRY(section_find(c, "factors", 4, voxel_count(n), &factor));
    TRY(voxels_create(m->gpu, m->work, m->job, n, s->data, factor->data, &m->voxels));
    m->frame = c->frame;
    m->years = c->years;
done:
    return st;
}

static status begin(struct model *m, const int n[3])
{
    status st = OK;
    float *share = NULL, *factor = NULL;
    TRY(memory_alloc(voxel_count(n), sizeof *share, "voxels", &share));
    TRY(memory_alloc(voxel_count(n), sizeof *factor, "voxels", &factor));
    TRY(scene_grid(m->job, m->job->goblins.floats, share, factor));
    TRY(voxels_create(m->gpu, m->work, m->job, n, share, factor, &m->voxels));
    m->frame = m->job->frames.first;
    for (size_t i = 0; i < voxel_count(n); i++)
        m->ledger.start += share[i] > 0;
    m->ledger.rock = m->ledger.start;
    TRY(remove_unsupported(m));
    if (m->ledger.fallen)
        log_warn("frame %d: %llu of %llu voxels have no face path to the ground and were taken out", m->frame,
                 (unsigned long long)m->ledger.fallen, (unsigned long long)m->ledger.start);
    TRY(voxels_download(m->gpu, &m->voxels, share, NULL));
    m->start_volume = volume_of(share, voxel_count(n), m->voxels.h);
done:
    free(share);
    free(factor);
    return st;
}

static void destroy(struct model **handle)
{
    struct model *m = *handle;
    if (!m)
        return;
    aov_destroy(m->gpu, &m->aov);
    field_destroy(m->gpu, &m->field);
    elastic_destroy(m->gpu, &m->elastic);
    blocks_destroy(m->gpu, &m->blocks);
    budget_destroy(m->gpu, &m->budget);
    voxels_destroy(m->gpu, &m->voxels);
    gpu_work_destroy(m->gpu, &m->work);
    free(m);
    *handle = NULL;
}

static size_t work_size(const struct job *job, const int n[3])
{
    size_t words, voxels = voxel_count(n) + 2;
    voxels_bytes(job, n, 0, &words);
    return words > voxels ? words : voxels;
}

static status create(struct gpu *gpu, const struct job *job, const struct checkpoint *from,
                     struct model **out)
{
    status st = OK;
    struct model *m = NULL;
    int n[3];
    double h = job->domain.spacing_m;
    struct elastic_options options = {
        .lambda = 1e9 * job->rock.lame_GPa,
        .mu = 1e9 * job->rock.shear_GPa,
        .density = job->rock.density_kg_m3,
        .gravity = job->rock.gravity_m_s2,
        .tolerance = job->stress.tolerance,
        .max_iterations = (int)job->stress.max_iterations,
    };
    TRY(memory_alloc(1, sizeof *m, "the model", &m));
    m->gpu = gpu;
    m->job = job;
    gpu_stage(gpu, "start");
    TRY(scene_voxels(job, n));
    TRY(gpu_work_create(gpu, work_size(job, n), &m->work));
    TRY(blocks_create(gpu, n, &m->blocks));
    TRY(budget_create(gpu, &m->budget));
    if (job->goblins.stress)
        TRY(elastic_create(gpu, n, h, &options, &m->elastic));
    TRY(field_create(gpu, n, h, &m->field));
    if (aov_pixels(job))
        TRY(aov_create(gpu, job, aov_pixels(job), &m->aov));
    TRY(from ? restore(m, from, n) : begin(m, n));
    *out = m;
    m = NULL;
done:
    destroy(&m);
    return st;
}

static status estimate(const struct job *job, struct model_estimate *out)
{
    status st = OK;
    size_t pixels = aov_pixels(job), words;
    struct scene_size size = {0};
    *out = (struct model_estimate){0};
    TRY(scene_voxels(job, out->voxels));
    TRY(scene_estimate(job, &size));
    out->n_particles = size.n_particles;
    size_t n = out->n_particles, voxels = voxel_count(out->voxels);
    uint64_t rock = 0, field = field_bytes(out->voxels), picture = aov_picture_bytes(job);
    for (int f = 0; f < ROCK_FIELDS; f++)
        rock += n * rock_field_size((enum rock_field)f);
    /* A third of the rock active is more than most have. */
    out->device_bytes = voxels_bytes(job, out->voxels, n / 3, &words) +
                        gpu_work_bytes(work_size(job, out->voxels)) + particles_bytes(n, out->voxels) +
                        blocks_bytes(out->voxels) + field + aov_bytes(pixels) +
                        (job->goblins.stress ? elastic_bytes(out->voxels) : 0);
    /* Two frames wait at most; files are made in memory. */
    out->host_bytes = 3 * (rock + field + picture * job->output.aov.n_cameras) + 8 * (uint64_t)voxels;
    /* Voxels' middles are a lattice, which packs well. */
    static const struct disk_particle bare = {3, 18, 1.5, 50, 1.5}, stressed = {10.6, 35, 2.2, 110, 1.9};
    out->disk = disk_frame(job, &size, job->goblins.stress ? &stressed : &bare);
    out->checkpoint_bytes = (uint64_t)(0.1 * 8 * (double)voxels);
    /* Cycles, about: a voxel's retreat takes four of them at a quantum of one half. */
    double most = 0;
    for (size_t i = 0; i < job->n_strata; i++)
        most = fmax(most, curve_max(&job->strata[i].weak_m_per_kyr));
    out->steps = (double)(job->frames.last - job->frames.first) *
                 (1 + job->clock.years_per_frame / 1000 * most / job->domain.spacing_m * 2 /
                          fmax(job->goblins.quantum, 0.05));
done:
    free(size.point);
    return st;
}

static int frame(const struct model *m)
{
    return m->frame;
}

const struct model_type goblins = {
    .name = "goblins",
    .estimate = estimate,
    .create = create,
    .destroy = destroy,
    .step = step,
    .frame = frame,
    .output = output,
    .save = save,
};
