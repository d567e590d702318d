/* Arches: terrain as stacks of material layers, shaped by tools, whose loose materials slide to rest (Peytavie et al. 2009).
 *
 * One frame is a list of stages (gpu_stage()):
 *
 *   tools         operation_apply() for each of the frame's operations, in the job's order; then loosen() what is unsupported
 *   stabilise     slide() loose material until it rests at its angle of repose
 *
 * output() then places rocks in rock layers, samples the smooth surface over the stacks, and adds the stages surface, field and
 * pictures.
 *
 * The state between frames consists of the stacks and the ledger. The ledger counts quanta of volume (stacks.h), exactly; tools that add
 * material add to its `start`; water is not counted.
 */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "frame/host.h"
#include "frame/rocks.h"
#include "model/resampling.h"
#include "model/sections.h"
#include "model/terrain.h"
#include "model/type.h"
#include "particles/particles.h"
#include "scene/scene.h"
#include "stacks/file.h"
#include "stacks/spaces.h"

struct arches {
    struct model m; /* shared by all models */
    struct material table[MATERIALS_MAX];
    int n_materials;
    struct stacks stacks;
    struct pile_tile tile;
    struct terrain_view view; /* of a frame, until release() */
};

static struct arches *of(struct model *m)
{
    return (struct arches *)m;
}

/* ---- a frame */

/* Updates the ledger by recounting the stacks: material added since the last count adds to `start`, removed material to `left`. */
static void balance(struct arches *t, uint64_t left)
{
    uint64_t before = t->m.ledger.rock + t->m.ledger.deposit, after;
    terrain_ledger(&t->stacks, t->table, t->n_materials, &t->m.ledger.rock, &t->m.ledger.deposit);
    after = t->m.ledger.rock + t->m.ledger.deposit + left;
    if (after > before)
        t->m.ledger.start += after - before;
    else
        t->m.ledger.left += before - after;
    t->m.ledger.left += left;
}

static void count(void *user, uint64_t left)
{
    balance(user, left);
}

/* Applies the frame's tools and lets loose material slide. `all`: material anywhere may slide, not only where tools were used. */
static status apply_tools(struct arches *t, bool all)
{
    status st = OK;
    const struct terrain_work work = {t->m.job, &t->stacks, t->table, t->n_materials, count, t};
    struct terrain_area area;
    gpu_stage(t->m.gpu, "tools");
    TRY(terrain_shape(&work, t->m.frame, all, &area));
    gpu_stage(t->m.gpu, "stabilise");
    TRY(terrain_slide(&work, t->m.frame, &area));
done:
    return st;
}

static status step(struct model *m)
{
    return apply_tools(of(m), false);
}

/* ---- what a frame shows */

/* The shares of the ground's materials. */
static status add_ratios(struct frame_grids *grids)
{
    status st = OK;
    struct frame_grid *grid;
    for (int value = 1; value < VALUES; value++)
        if (value_table[value].from == FROM_TERRAIN)
            TRY(frame_grids_add(grids, (enum value_id)value, &grid));
done:
    return st;
}

static status read_terrain(struct model *m, enum value_id which, float *out)
{
    terrain_ratio(&of(m)->view, value_material[which], out);
    return OK;
}

static void release(struct model *m)
{
    terrain_view_free(&of(m)->view);
}

/* Samples the terrain and makes the files' content from the samples. */
static status show(struct arches *t, struct frame_wants wants, struct frame *out)
{
    status st = OK;
    struct model *m = &t->m;
    struct terrain_view *v = &t->view;
    *v = (struct terrain_view){.job = m->job,
                               .stacks = &t->stacks,
                               .n_materials = t->n_materials,
                               .voxel = m->field.voxel,
                               .cut = m->field.cut};
    memcpy(v->n, m->field.n, sizeof v->n);
    memcpy(v->origin, m->field.origin, sizeof v->origin);
    gpu_stage(m->gpu, "surface");
    TRY(terrain_sample(v));
    TRY(particles_create(m->gpu, m->work, &v->rock, DERIVED, m->voxels, m->h, &m->made));
    m->made.walls = job_walls(m->job);
    m->shown = &m->made;
    rock_free(&v->rock);
    gpu_stage(m->gpu, "field");
    const struct field_share known = {v->bricks.count, v->bricks.number, v->bricks.slot, v->share};
    TRY(field_build_share(m->gpu, &m->field, &m->made, &known));
    free(v->share);
    v->share = NULL;
    if (wants.points)
        TRY(particles_download(m->gpu, &m->made, DERIVED, &out->rock));
    if (wants.volumes) {
        TRY(model_grids(m, HAS_ALWAYS, &out->grids));
        TRY(add_ratios(&out->grids));
    }
    if (wants.pictures) {
        gpu_stage(m->gpu, "pictures");
        TRY(aov_render_all(m->gpu, &m->aov, m->job, &m->field, &m->made, NULL, out));
    }
done:
    return st;
}

static status add_map(const struct arches *t, struct frame *out)
{
    status st = OK;
    size_t capacity = out->n_images;
    TRY(memory_grow(&out->image, &capacity, out->n_images + 1, sizeof *out->image, "pictures"));
    TRY(terrain_map(&t->stacks, t->n_materials, &out->image[out->n_images++]));
done:
    return st;
}

/* Quanta in cubic metres. */
static double volume_of(const struct arches *t, uint64_t quanta)
{
    return (double)quanta * t->stacks.quantum * t->stacks.cell * t->stacks.cell;
}

static bool wants_stacks(const struct job *job, int frame)
{
    return job->arches.stacks == STACKS_ALL ||
           (job->arches.stacks == STACKS_LAST && frame == job->frames.last);
}

static status output(struct model *m, struct frame *out)
{
    status st = OK;
    struct arches *t = of(m);
    const struct frame_wants wants = model_wants(m);
    out->volume_m3 = volume_of(t, m->ledger.rock + m->ledger.deposit);
    out->start_volume_m3 = volume_of(t, m->ledger.start);
    if (wants.volumes)
        TRY(rocks_on_stacks(m->job, &t->stacks, &t->tile, &out->rocks));
    if (m->makes == MAKES_FILES && wants_stacks(m->job, m->frame))
        TRY(stacks_encode(&t->stacks, spaces_kinds(t->table, t->n_materials).solid, &out->stacks.bytes,
                          &out->stacks.size));
    if (wants.points || wants.volumes || wants.pictures)
        TRY(show(t, wants, out));
    if (m->makes == MAKES_FILES && m->job->arches.maps && job_writes(m->whole, JOB_PICTURES, m->frame))
        TRY(add_map(t, out));
done:
    return st;
}

/* ---- the state */

static size_t stack_count(const struct arches *t)
{
    return (size_t)t->stacks.n[0] * (size_t)t->stacks.n[1];
}

static status save(struct model *m, struct checkpoint *out)
{
    status st = OK;
    struct arches *t = of(m);
    void *count, *layer;
    TRY(section_add(out, "stack counts", 4, stack_count(t), &count));
    TRY(section_add(out, "stack layers", 4, stacks_layers(&t->stacks), &layer));
    stacks_pack(&t->stacks, count, layer);
    TRY(sections_add_counts(out, m));
done:
    return st;
}

static status restore(struct model *m, const struct checkpoint *c)
{
    status st = OK;
    struct arches *t = of(m);
    const struct ledger stored = m->ledger;
    const void *counts, *layers;
    size_t n;
    TRY(section_get(c, &(struct section_rule){"stack counts", SECTION_WORD, stack_count(t), 1, {SECTION_ALL}},
                    &counts, NULL));
    TRY(section_get(c, &(struct section_rule){"stack layers", SECTION_WORD, SECTION_ANY, 1, {SECTION_ALL}},
                    &layers, &n));
    for (size_t i = 0; i < n; i++) {
        uint32_t material = layer_material(((const uint32_t *)layers)[i]);
        if (material >= (uint32_t)t->n_materials)
            return section_refuse(c, "stack layers", i, "is of material %u, but this job has %d materials",
                                  (unsigned)material, t->n_materials);
    }
    st = stacks_unpack(&t->stacks, counts, layers, n);
    if (st == E_INPUT)
        st = fail(E_CHECKPOINT,
                  "the checkpoint of frame %d is damaged: sections 'stack counts' and 'stack layers': %s",
                  c->frame, status_message());
    TRY(st);
    terrain_ledger(&t->stacks, t->table, t->n_materials, &m->ledger.rock, &m->ledger.deposit);
    if (memcmp(&stored, &m->ledger, sizeof stored) != 0)
        st = fail(
            E_CHECKPOINT,
            "the checkpoint of frame %d is damaged: section 'ledger' counts %llu of rock and %llu deposited, but the stacks have %llu and %llu",
            c->frame, (unsigned long long)stored.rock, (unsigned long long)stored.deposit,
            (unsigned long long)m->ledger.rock, (unsigned long long)m->ledger.deposit);
done:
    return st;
}

static status begin(struct model *m)
{
    status st = OK;
    struct arches *t = of(m);
    TRY(terrain_begin(m->job, t->table, t->n_materials, true, &t->stacks));
    balance(t, 0);
    TRY(apply_tools(t, true));
done:
    return st;
}

static status create(struct model *m)
{
    status st = OK;
    struct arches *t = of(m);
    TRY(terrain_materials(m->job, t->table, &t->n_materials));
    TRY(terrain_create(m->job, &t->stacks));
    TRY(rocks_tile(m->job, &t->tile));
done:
    return st;
}

static void destroy(struct model *m)
{
    struct arches *t = of(m);
    pile_tile_destroy(&t->tile);
    stacks_destroy(&t->stacks);
}

/* ---- what a job takes */

static size_t work_items(const struct job *job, const int voxels[3])
{
    (void)job;
    return voxel_count(voxels) + 2;
}

/* Samples in the bricks near that many faces of voxels. Each face has a brick's depth and the margin around it, 16 samples; bricks near
 * several faces are counted once, as if faces were anywhere in the domain. Within a fifth of what frames have. */
static uint64_t samples_of(const int voxels[3], double faces)
{
    int lattice[3], bricks[3];
    for (int a = 0; a < 3; a++)
        lattice[a] = voxels[a] + 2 * FIELD_MARGIN;
    const double all = (double)(grid_bricks_of(lattice, bricks) * BRICK_SAMPLES);
    return (uint64_t)(all * (1 - exp(-16 * faces / all)));
}

static status estimate(const struct job *job, struct model_needs *needs)
{
    status st = OK;
    const int *n = needs->voxels;
    struct scene_size ground;
    /* For its errors only, if the scene is wrong. */
    TRY(scene_estimate(job, &ground));
    free(ground.point);
    struct terrain_size size;
    TRY(terrain_size(job, &size));
    const double h = job->domain.spacing_m, cell = terrain_cell(job), face = h * h;
    const double stacks = job->domain.size_m[0] * job->domain.size_m[1] / (cell * cell) * size.layers;
    /* The filter's width in voxels is how many samples on a line across the surface are neither air nor full. */
    const double filter = 2 * terrain_sigma(job, cell, h) / h;
    needs->size.n_particles = (size_t)(filter * size.surface_m2 / face + size.side_m2 / face);
    /* Particles are only at the surface. */
    needs->size.n_surface = needs->size.n_near = needs->size.n_kept = needs->capacity =
        needs->size.n_particles;
    needs->disk = (struct disk_particle){.bare = 9, .volumes_bare = 30, .channel = 1.1};
    needs->frame.samples = samples_of(n, (size.surface_m2 + size.side_m2) / face);
    needs->frame.grids = value_grids(HAS_TERRAIN);
    /* Sorting the rock on the device needs an extra vector and word per particle. */
    needs->device_bytes = 20 * needs->size.n_particles;
    /* The samples of a frame are freed before the frame is complete, so only the stacks count. */
    needs->host_bytes = (uint64_t)(4 * stacks);
    needs->checkpoint_bytes = (uint64_t)(0.6 * stacks);
    if (job->arches.stacks == STACKS_ALL)
        needs->disk_other = needs->checkpoint_bytes;
    needs->steps = job->frames.last - job->frames.first;
    needs->kernels = 40;
done:
    return st;
}

/* The stacks do not depend on the spacing of the voxels that show them, if the job gives their size. */
static status resample(struct resampling *r)
{
    status st = OK;
    const double was = terrain_cell(&r->before), is = terrain_cell(r->job);
    if (was != is)
        return fail(
            E_CHECKPOINT,
            "the checkpoint of frame %d has stacks of %g m, which are not resampled; to show them at domain.spacing_m: %g, set arches.cell_m: %g",
            r->from->frame, was, is, was);
    TRY(resampling_keep(r, "stack "));
    r->counts = r->ledger;
    r->times = 1;
done:
    return st;
}

const struct model_type arches_type = {
    .size = sizeof(struct arches),
    .estimate = estimate,
    .work_items = work_items,
    .create = create,
    .begin = begin,
    .restore = restore,
    .destroy = destroy,
    .step = step,
    .output = output,
    .read_terrain = read_terrain,
    .release = release,
    .save = save,
    .resample = resample,
};
