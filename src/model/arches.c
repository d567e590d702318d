/* Arches: terrain as stacks of layers, made by tools and left to settle (Peytavie et al. 2009).
 *
 * One frame:
 *
 *   tools at work in it, in the job's order -> what nothing holds -> stabilise -> ledger
 *
 * output() then samples the smooth surface over the stacks, and where rock layers are, places rocks. The state
 * between frames is the stacks and the ledger. The ledger counts quanta (stacks.h): volume, exactly; tools that
 * add material add to its start, water is not in it.
 */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/log.h"
#include "base/memory.h"
#include "field/aov.h"
#include "field/field.h"
#include "frame/rocks.h"
#include "model/model.h"
#include "model/sections.h"
#include "model/terrain.h"
#include "particles/particles.h"
#include "scene/noise.h"
#include "scene/scene.h"
#include "stacks/file.h"
#include "stacks/loosen.h"
#include "stacks/operations.h"
#include "stacks/stabilise.h"

struct model {
    struct gpu *gpu;
    const struct job *job;
    int frame;
    struct ledger ledger;
    struct material table[MATERIALS_MAX];
    int n_materials;
    struct stacks stacks;
    struct pile_tile tile;
    struct gpu_work *work;
    struct field field;
    struct aov aov;
};

static size_t voxel_count(const int n[3])
{
    return (size_t)n[0] * (size_t)n[1] * (size_t)n[2];
}

/* ---- a frame */

/* Noise of a tool's own scale; cheap to set up beside what is done with it. */
static double tool_noise(const void *user, double scale, double flatten, const double x[3])
{
    const struct model *m = user;
    struct job_noise of = {.scale_m = scale, .octaves = 3, .flatten = flatten};
    struct noise noise = noise_init(&of, (uint32_t)m->job->seed);
    return noise_at(&noise, x);
}

/* What the tools did is known by what is there. */
static void balance(struct model *m, uint64_t left)
{
    uint64_t before = m->ledger.rock + m->ledger.deposit, after;
    terrain_ledger(&m->stacks, m->table, m->n_materials, &m->ledger.rock, &m->ledger.deposit);
    after = m->ledger.rock + m->ledger.deposit + left;
    if (after > before)
        m->ledger.start += after - before;
    else
        m->ledger.left += before - after;
    m->ledger.left += left;
}

static status settle(struct model *m, const int lo[2], const int hi[2])
{
    struct stabilise options = {.table = m->table,
                                .n_materials = m->n_materials,
                                .open_edges = m->job->arches.edges == EDGES_OPEN,
                                .sweeps = m->job->arches.sweeps};
    struct stabilised done;
    uint64_t left = 0;
    if (lo[0] > hi[0])
        return OK;
    status st = stabilise(&m->stacks, &options, lo, hi, &done);
    if (st != OK)
        return st;
    for (int k = 0; k < MATERIALS_MAX; k++)
        left += done.left[k];
    balance(m, left);
    if (!done.resting && !options.sweeps)
        log_warn("frame %d: after %lld sweeps some loose material still moves", m->frame,
                 (long long)done.sweeps);
    return OK;
}

static void extend(int lo[2], int hi[2], const int from[2], const int to[2])
{
    for (int a = 0; a < 2; a++) {
        lo[a] = from[a] < lo[a] ? from[a] : lo[a];
        hi[a] = to[a] > hi[a] ? to[a] : hi[a];
    }
}

/* The tools of this frame, and what follows from them. `all`: whatever else may slide, does. */
static status work(struct model *m, bool all)
{
    status st = OK;
    const struct job_arches *job = &m->job->arches;
    struct tools tools = {.table = m->table,
                          .n_materials = m->n_materials,
                          .sigma = job->sigma * m->stacks.cell,
                          .noise = tool_noise,
                          .user = m};
    int lo[2] = {m->stacks.n[0], m->stacks.n[1]}, hi[2] = {-1, -1}, from[2], to[2];
    gpu_stage(m->gpu, "tools");
    for (size_t i = 0; i < job->n_operations; i++) {
        char path[64];
        if (!operation_active(&job->operations[i], m->frame))
            continue;
        snprintf(path, sizeof path, "arches.operations.%zu", i);
        TRY(operation_apply(&m->stacks, &tools, &job->operations[i], path, m->frame, from, to));
        balance(m, 0);
        extend(lo, hi, from, to);
    }
    /* Where slides go on from frame to frame, anything may be under way. */
    if (all || job->sweeps)
        for (int a = 0; a < 2; a++) {
            lo[a] = 0;
            hi[a] = m->stacks.n[a] - 1;
        }
    if (job->unheld == UNHELD_FALL && lo[0] <= hi[0]) {
        TRY(loosen(&m->stacks, spaces_kinds(m->table, m->n_materials).solid, from, to));
        extend(lo, hi, from, to);
    }
    gpu_stage(m->gpu, "stabilise");
    TRY(settle(m, lo, hi));
done:
    return st;
}

static status step(struct model *m)
{
    m->frame++;
    return work(m, false);
}

/* ---- what a frame shows */

static status add_ratios(struct terrain_view *v, struct frame_grids *grids)
{
    static const char *const names[4] = {"bedrock", "sand", "rock", "water"};
    for (int r = 0; r < 4; r++) {
        grids->grid[grids->n_grids++] =
            (struct frame_grid){.name = names[r], .unit = "", .kind = GRID_PLAIN, .value = v->ratio[r]};
        v->ratio[r] = NULL; /* the frame's now */
    }
    return OK;
}

static status show(struct model *m, struct terrain_view *v, struct particles *p, struct frame *out)
{
    status st = OK;
    const struct job *job = m->job;
    gpu_stage(m->gpu, "field");
    TRY(field_build_share(m->gpu, &m->field, p, v->share));
    TRY(particles_download(m->gpu, p, DERIVED, &out->rock));
    TRY(field_download(m->gpu, &m->field, p, NULL, 0, &out->grids));
    TRY(add_ratios(v, &out->grids));
    gpu_stage(m->gpu, "pictures");
    TRY(aov_render_all(m->gpu, &m->aov, job, &m->field, p, NULL, out));
    if (job->arches.maps) {
        size_t capacity = job->output.aov.n_cameras;
        TRY(memory_grow(&out->image, &capacity, out->n_images + 1, sizeof *out->image, "pictures"));
        TRY(terrain_map(&m->stacks, m->n_materials, &out->image[out->n_images++]));
    }
done:
    return st;
}

/* Quanta in cubic metres. */
static double volume_of(const struct model *m, uint64_t quanta)
{
    return (double)quanta * m->stacks.quantum * m->stacks.cell * m->stacks.cell;
}

static status output(struct model *m, struct frame *out)
{
    status st = OK;
    struct particles p = {0};
    struct terrain_view v = {
        .job = m->job, .stacks = &m->stacks, .n_materials = m->n_materials, .voxel = m->field.voxel};
    int voxels[3];
    memcpy(v.n, m->field.n, sizeof v.n);
    memcpy(v.origin, m->field.origin, sizeof v.origin);
    for (int a = 0; a < 3; a++)
        voxels[a] = v.n[a] - 2 * FIELD_MARGIN;
    *out = (struct frame){.number = m->frame,
                          .years = (m->frame - m->job->frames.first) * m->job->clock.years_per_frame,
                          .ledger = m->ledger,
                          .volume_m3 = volume_of(m, m->ledger.rock + m->ledger.deposit),
                          .start_volume_m3 = volume_of(m, m->ledger.start)};
    gpu_stage(m->gpu, "surface");
    TRY(terrain_look(&v));
    TRY(rocks_on_stacks(m->job, &m->stacks, &m->tile, &out->rocks));
    if (m->job->arches.stacks == STACKS_ALL ||
        (m->job->arches.stacks == STACKS_LAST && m->frame == m->job->frames.last))
        TRY(stacks_encode(&m->stacks, spaces_kinds(m->table, m->n_materials).solid, &out->stacks.bytes,
                          &out->stacks.size));
    TRY(particles_create(m->gpu, m->work, &v.rock, DERIVED, voxels, m->job->domain.spacing_m, &p));
    TRY(show(m, &v, &p, out));
done:
    particles_destroy(m->gpu, &p);
    terrain_view_free(&v);
    if (st != OK)
        frame_free(out);
    return st;
}

/* ---- the state */

static status save(struct model *m, struct checkpoint *out)
{
    status st = OK;
    void *count, *layer, *data;
    *out = (struct checkpoint){.frame = m->frame,
                               .years = (m->frame - m->job->frames.first) * m->job->clock.years_per_frame};
    TRY(section_add_domain(out, m->job));
    TRY(section_add(out, "stack counts", 4, (size_t)m->stacks.n[0] * (size_t)m->stacks.n[1], &count));
    TRY(section_add(out, "stack layers", 4, stacks_layers(&m->stacks), &layer));
    stacks_pack(&m->stacks, count, layer);
    TRY(section_add(out, "ledger", 8, sizeof m->ledger / 8, &data));
    memcpy(data, &m->ledger, sizeof m->ledger);
done:
    if (st != OK)
        checkpoint_free(out);
    return st;
}

static status restore(struct model *m, const struct checkpoint *c)
{
    status st = OK;
    const struct checkpoint_section *s, *layers;
    TRY(section_check_domain(c, m->job));
    TRY(section_find(c, "ledger", 8, sizeof m->ledger / 8, &s));
    memcpy(&m->ledger, s->data, sizeof m->ledger);
    TRY(section_find(c, "stack counts", 4, (size_t)m->stacks.n[0] * (size_t)m->stacks.n[1], &s));
    TRY(section_find(c, "stack layers", 4, 0, &layers));
    if (stacks_unpack(&m->stacks, s->data, layers->data, layers->n) != OK) {
        st = fail(E_CHECKPOINT, "the checkpoint of frame %d holds damaged stacks", c->frame);
        goto done;
    }
    m->frame = c->frame;
done:
    return st;
}

static status begin(struct model *m)
{
    status st = OK;
    m->frame = m->job->frames.first;
    TRY(terrain_begin(m->job, m->table, m->n_materials, &m->stacks));
    balance(m, 0);
    TRY(work(m, true));
done:
    return st;
}

static void destroy(struct model **handle)
{
    struct model *m = *handle;
    if (!m)
        return;
    aov_destroy(m->gpu, &m->aov);
    field_destroy(m->gpu, &m->field);
    gpu_work_destroy(m->gpu, &m->work);
    pile_tile_destroy(&m->tile);
    stacks_destroy(&m->stacks);
    free(m);
    *handle = NULL;
}

static status create(struct gpu *gpu, const struct job *job, const struct checkpoint *from,
                     struct model **out)
{
    status st = OK;
    struct model *m = NULL;
    int n[3];
    TRY(memory_alloc(1, sizeof *m, "the model", &m));
    m->gpu = gpu;
    m->job = job;
    gpu_stage(gpu, "start");
    TRY(scene_voxels(job, n));
    TRY(terrain_materials(job, m->table, &m->n_materials));
    TRY(terrain_create(job, &m->stacks));
    TRY(rocks_tile(job, &m->tile));
    TRY(gpu_work_create(gpu, voxel_count(n) + 2, &m->work));
    TRY(field_create(gpu, n, job->domain.spacing_m, &m->field));
    if (aov_pixels(job))
        TRY(aov_create(gpu, job, aov_pixels(job), &m->aov));
    TRY(from ? restore(m, from) : begin(m));
    *out = m;
    m = NULL;
done:
    destroy(&m);
    return st;
}

static status estimate(const struct job *job, struct model_estimate *out)
{
    status st = OK;
    size_t pixels = aov_pixels(job);
    double cell = job->arches.cell_m > 0 ? job->arches.cell_m : job->domain.spacing_m;
    *out = (struct model_estimate){0};
    TRY(scene_voxels(job, out->voxels));
    const int *n = out->voxels;
    size_t voxels = voxel_count(n);
    /* The surface's voxels, about: caves and walls as much again as the ground, three voxels thick; the sides. */
    out->n_particles = 6 * (size_t)n[0] * (size_t)n[1] + 2 * (size_t)(n[0] + n[1]) * (size_t)n[2];
    uint64_t rock = 0, field = field_bytes(n), picture = aov_picture_bytes(job);
    for (int f = 0; f < ROCK_FIELDS; f++)
        rock += out->n_particles * rock_field_size((enum rock_field)f);
    double stacks = job->domain.size_m[0] * job->domain.size_m[1] / (cell * cell) * 28;
    out->device_bytes =
        gpu_work_bytes(voxels + 2) + particles_bytes(out->n_particles, n) + field + aov_bytes(pixels);
    /* Two frames wait at most; files are made in memory. */
    out->host_bytes = 3 * (rock + 2 * field + picture * job->output.aov.n_cameras) + (uint64_t)(4 * stacks);
    /* The surface alone, on a lattice. */
    const struct scene_size size = {.n_particles = out->n_particles, .n_surface = out->n_particles};
    out->disk = disk_frame(job, &size, &(struct disk_particle){0, 9, 0, 30, 1.1});
    if (job->arches.stacks == STACKS_ALL)
        out->disk.other += (uint64_t)(0.6 * stacks);
    out->checkpoint_bytes = (uint64_t)(0.6 * stacks);
    out->steps = job->frames.last - job->frames.first;
done:
    return st;
}

static int frame(const struct model *m)
{
    return m->frame;
}

const struct model_type arches = {
    .name = "arches",
    .estimate = estimate,
    .create = create,
    .destroy = destroy,
    .step = step,
    .frame = frame,
    .output = output,
    .save = save,
};
