/* What all models have in common. */
#include "model/type.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/log.h"
#include "base/memory.h"
#include "frame/host.h"
#include "model/sections.h"
#include "particles/grids.h"
#include "particles/particles.h"
#include "scene/scene.h"

#define MODEL(constant, word, ...) extern const struct model_type word##_type;
JOB_MODELS(MODEL)
#undef MODEL

const struct model_type *model_type_of(const struct job *job)
{
#define MODEL(constant, word, ...) [MODEL_##constant] = &word##_type,
    static const struct model_type *const types[] = {JOB_MODELS(MODEL)};
#undef MODEL
    return types[job->model];
}

/* ---- the estimate */

/* Bytes of host memory that frames may take if the job does not say. */
static const double AUTOMATIC = 2e9;

/* Chooses the fastest pace that output.memory_GB allows. */
static status choose_pace(const struct job *job, struct model_estimate *e)
{
    const double most = job->output.memory_GB > 0 ? job->output.memory_GB * 1e9 : AUTOMATIC;
    e->pace = PACE_OVERLAP;
    while (e->pace < PACE_STREAM && (double)e->host_at[e->pace] > most)
        e->pace++;
    e->host_bytes = e->host_at[e->pace];
    if (job->output.memory_GB <= 0 || (double)e->host_bytes <= most)
        return OK;
    return fail(
        E_USAGE,
        "output.memory_GB: %g GB are less than the %.3f GB that one frame of %zu particles takes besides the device; set output.memory_GB to at least %.2f, or raise domain.spacing_m",
        job->output.memory_GB, (double)e->host_bytes / 1e9, e->n_particles,
        ceil((double)e->host_bytes / 1e7) / 100);
}

status model_estimate(const struct job *job, struct model_estimate *out)
{
    status st = OK;
    const struct model_type *type = model_type_of(job);
    struct model_needs needs = {.voxels = out->voxels};
    *out = (struct model_estimate){0};
    TRY(scene_voxels(job, out->voxels));
    TRY(type->estimate(job, &needs));
    const size_t n = needs.size.n_particles;
    out->n_particles = n;
    out->device_bytes = needs.device_bytes + gpu_work_bytes(type->work_items(job, out->voxels)) +
                        particles_bytes(needs.capacity, out->voxels) +
                        field_bytes(out->voxels, needs.frame.samples) + aov_bytes(aov_pixels(job));
    out->disk = disk_frame(job, &needs.size, &needs.disk);
    out->disk.other += needs.disk_other;
    needs.frame.grids += value_grids(HAS_ALWAYS);
    for (int p = 0; p < PACES; p++)
        out->host_at[p] = needs.host_bytes +
                          host_frames_bytes(job, &needs.size, &needs.frame, &out->disk, (enum frame_pace)p);
    out->checkpoint_bytes = needs.checkpoint_bytes;
    out->steps = needs.steps;
    out->kernels = needs.kernels;
    TRY(choose_pace(job, out));
done:
    free(needs.size.point);
    return st;
}

/* ---- grids whose samples are on the device */

static status read_grid(void *user, const struct frame_grid *grid, float **out)
{
    status st = OK;
    struct model *m = user;
    const enum value_id which = value_of_name(grid->name);
    float *value = NULL;
    TRY(memory_alloc(m->field.n_bricks * BRICK_SAMPLES, (size_t)grid->components * sizeof *value, grid->name,
                     &value));
    TRY(value_table[which].from == FROM_TERRAIN ? m->type->read_terrain(m, which, value)
                                                : field_read(m->gpu, &m->field, m->shown, which, value));
    *out = value;
    value = NULL;
done:
    free(value);
    return st;
}

status model_grids(struct model *m, unsigned has, struct frame_grids *out)
{
    const status st = field_grids(m->gpu, &m->field, has, out);
    out->source = (struct grid_source){m, read_grid};
    return st;
}

void model_stream(struct model *m)
{
    m->streams = true;
}

/* Frees what the last frame's grids are read from. */
static void release(struct model *m)
{
    if (m->type->release)
        m->type->release(m);
    if (m->shown == &m->made)
        m->shown = NULL;
    particles_destroy(m->gpu, &m->made);
}

/* ---- the state */

static status restore_counts(struct model *m, const struct checkpoint *c)
{
    status st = OK;
    const struct section_rule volume = {"start volume", SECTION_DOUBLE, 1, 1, {{0, SECTION_COUNT_MAX}}};
    const struct section_rule change = {
        "change", SECTION_INTEGER, PROCESSES, 1, {{-SECTION_COUNT_MAX, SECTION_COUNT_MAX}}};
    const void *data;
    TRY(section_check_domain(c, m->job));
    TRY(section_get_ledger(c, &m->ledger));
    if (!job_has_processes(m->job))
        return OK;
    TRY(section_get(c, &volume, &data, NULL));
    memcpy(&m->start_volume, data, sizeof m->start_volume);
    TRY(section_get(c, &change, &data, NULL));
    memcpy(m->change, data, sizeof m->change);
done:
    return st;
}

status sections_add_counts(struct checkpoint *c, const struct model *m)
{
    status st = OK;
    void *data;
    TRY(section_add(c, "ledger", 8, sizeof m->ledger / 8, &data));
    memcpy(data, &m->ledger, sizeof m->ledger);
    if (!job_has_processes(m->job))
        return OK;
    TRY(section_add(c, "start volume", 8, 1, &data));
    memcpy(data, &m->start_volume, sizeof m->start_volume);
    TRY(section_add(c, "change", 8, PROCESSES, &data));
    memcpy(data, m->change, sizeof m->change);
done:
    return st;
}

static status create_shared(struct model *m)
{
    status st = OK;
    TRY(scene_voxels(m->job, m->voxels));
    TRY(numbers_create(m->gpu, &m->found));
    TRY(gpu_work_create(m->gpu, m->type->work_items(m->whole, m->voxels), &m->work));
    if (job_has_processes(m->job))
        TRY(budget_create(m->gpu, &m->budget));
    TRY(field_create(m->gpu, m->voxels, m->h, &m->field));
    if (aov_pixels(m->whole))
        TRY(aov_create(m->gpu, m->whole, aov_pixels(m->whole), &m->aov));
done:
    return st;
}

static bool is_among(const char *name, const char *const *names, size_t n)
{
    for (size_t i = 0; i < n; i++)
        if (strcmp(name, names[i]) == 0)
            return true;
    return false;
}

bool watch_between(const struct watch_list *list, const char *by, const char *before)
{
    const char *const next[] = {before, "checkpoint", "field"};
    return strcmp(list->stage, by) == 0 || is_among(list->next, next, sizeof next / sizeof *next);
}

static status stage_ended(void *user, const char *stage, const char *next)
{
    const struct model *m = user;
    struct watch_list list = {.stage = stage, .next = next};
    const size_t samples = m->field.n_bricks * BRICK_SAMPLES;
    watch_particles(&list, m->shown);
    if (strcmp(stage, "field") == 0) {
        watch_add(&list, "the rock's share", m->field.share, samples);
        watch_add(&list, "the field's means", m->field.means, samples);
        watch_add(&list, "the surface's distance", m->field.distance, samples);
    }
    if (m->type->watch)
        m->type->watch(m, &list);
    if (m->stage && next)
        m->stage(m->stage_user, m->frame, next);
    return numbers_check(m->gpu, m->found, &list, m->frame);
}

void model_on_stage(struct model *m, void (*begun)(void *user, int frame, const char *name), void *user)
{
    m->stage = begun;
    m->stage_user = user;
}

status model_create(struct gpu *gpu, const struct job *job, const struct checkpoint *from, struct model **out)
{
    status st = OK;
    struct model *m = NULL;
    const struct model_type *type = model_type_of(job);
    TRY(memory_alloc(1, type->size, "the model", &m));
    m->type = type;
    m->gpu = gpu;
    m->whole = job;
    m->h = job->domain.spacing_m;
    m->frame = from ? from->frame : job->frames.first;
    m->years = from ? from->years : 0;
    m->job = job_at(job, m->frame);
    gpu_stage(gpu, "start");
    TRY(create_shared(m));
    TRY(type->create(m));
    if (from)
        TRY(restore_counts(m, from));
    TRY(from ? type->restore(m, from) : type->begin(m));
    gpu_watch(gpu, stage_ended, m);
    *out = m;
    m = NULL;
done:
    model_destroy(&m);
    return st;
}

void model_destroy(struct model **handle)
{
    struct model *m = *handle;
    if (!m)
        return;
    gpu_watch(m->gpu, NULL, NULL);
    release(m);
    m->type->destroy(m);
    gpu_buffer_destroy(m->gpu, &m->found);
    aov_destroy(m->gpu, &m->aov);
    field_destroy(m->gpu, &m->field);
    budget_destroy(m->gpu, &m->budget);
    gpu_work_destroy(m->gpu, &m->work);
    free(m);
    *handle = NULL;
}

status model_save(struct model *m, struct checkpoint *out)
{
    status st = OK;
    *out = (struct checkpoint){.frame = m->frame, .years = m->years};
    release(m);
    gpu_stage(m->gpu, "checkpoint");
    TRY(section_add_domain(out, m->job));
    TRY(m->type->save(m, out));
done:
    if (st != OK)
        checkpoint_free(out);
    return st;
}

/* ---- a frame */

int model_frame(const struct model *m)
{
    return m->frame;
}

status model_step(struct model *m)
{
    status st = OK;
    const bool budgets = job_has_processes(m->job);
    release(m);
    m->frame++;
    m->job = job_at(m->whole, m->frame);
    m->years += m->job->clock.years_per_frame;
    if (budgets)
        budget_clear(m->gpu, &m->budget);
    TRY(m->type->step(m));
    if (budgets)
        TRY(budget_read(m->gpu, &m->budget, m->change));
done:
    return st;
}

/* Logs the numbers that memory and time depend on. */
static void note_size(const struct model *m)
{
    int bricks[3];
    log_note("frame %d: %zu particles, %zu voxels of rock without particles, %zu of %zu bricks of the field",
             m->frame, m->shown ? m->shown->n : 0, m->shown ? m->shown->n_deep : 0, m->field.n_bricks,
             grid_bricks_of(m->field.n, bricks));
}

status model_output(struct model *m, struct frame *out)
{
    status st = OK;
    *out = (struct frame){
        .number = m->frame, .years = m->years, .ledger = m->ledger, .start_volume_m3 = m->start_volume};
    for (int p = 0; p < PROCESSES; p++)
        if (job_has_process(m->job, (enum process)p))
            out->change[out->n_changes++] =
                (struct frame_change){job_processes[p].name, budget_m3(m->change[p], m->h)};
    release(m);
    TRY(m->type->output(m, out));
    note_size(m);
    for (size_t g = 0; g < out->grids.n_grids && !m->streams; g++)
        TRY(frame_grid_read(&out->grids, &out->grids.grid[g]));
done:
    if (st != OK)
        frame_free(out);
    if (st != OK || !m->streams)
        release(m);
    return st;
}

status model_pictures(struct model *m, const struct field_cut *cut, struct frame *out)
{
    m->makes = MAKES_PICTURES;
    m->aov.ground = true;
    m->field.cut = *cut;
    const status st = model_output(m, out);
    m->makes = MAKES_FILES;
    m->aov.ground = false;
    m->field.cut = (struct field_cut){0};
    return st;
}

status model_measure(struct model *m, struct frame *out)
{
    m->makes = MAKES_NUMBERS;
    const status st = model_output(m, out);
    m->makes = MAKES_FILES;
    return st;
}

struct frame_wants model_wants(const struct model *m)
{
    const struct job *job = m->whole;
    const bool only = m->makes != MAKES_FILES;
    struct frame_wants wants = {
        .points = !only && job_writes(job, JOB_POINTS, m->frame),
        .volumes = !only && job_writes(job, JOB_VOLUMES, m->frame),
        .pictures = job->output.aov.n_cameras > 0 &&
                    (m->makes == MAKES_PICTURES || (!only && job_writes(job, JOB_PICTURES, m->frame))),
    };
    wants.air = (wants.volumes && job->output.vdb.wind) ||
                (wants.pictures && job_wants_layer(job, value_table[VALUE_wind].layer));
    return wants;
}

double model_sum(const float *left, size_t n)
{
    double sum = 0;
    for (size_t i = 0; i < n; i++)
        sum += (double)left[i];
    return sum;
}

void model_budget_before(struct model *m, enum process process, struct gpu_buffer *left, size_t n)
{
    budget_sum(m->gpu, &m->budget, process, false, left, n);
}

void model_budget_after(struct model *m, enum process process, struct gpu_buffer *left, size_t n)
{
    budget_sum(m->gpu, &m->budget, process, true, left, n);
}

status model_check_supported(const struct model *m, double lowest, bool whole)
{
    const struct ledger *l = &m->ledger;
    if (l->rock + l->deposit == 0 || (!whole && l->fallen > 0 && lowest < HUGE_VAL)) {
        if (lowest < HUGE_VAL)
            return scene_fail_floating(lowest);
        return fail(
            E_USAGE,
            "scene: no voxel is at least half rock, so no rock is supported; lower domain.spacing_m (%.4g m) or make the shapes thicker",
            m->h);
    }
    if (l->fallen)
        log_warn("frame %d: %llu of %llu %s are not connected to the ground through faces and were removed",
                 m->frame, (unsigned long long)l->fallen, (unsigned long long)l->start,
                 job_model(m->job)->samples);
    return OK;
}
