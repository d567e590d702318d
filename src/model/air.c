#include "model/air.h"

#include <stdlib.h>
#include <string.h>

#include "base/log.h"
#include "base/memory.h"
#include "model/sections.h"

static size_t samples(const struct grid_lattice *l)
{
    return (size_t)l->n[0] * (size_t)l->n[1] * (size_t)l->n[2];
}

static size_t place_of(const struct grid_lattice *l, int x, int y, int z)
{
    return ((size_t)z * (size_t)l->n[1] + (size_t)y) * (size_t)l->n[0] + (size_t)x;
}

/* Begins grids on a lattice with all of its bricks. */
static status begin_whole(const struct wind_lattice *air, struct frame_grids *out)
{
    status st = OK;
    struct grid_lattice lattice = {.voxel = air->cell};
    uint32_t *number = NULL;
    for (int a = 0; a < 3; a++) {
        lattice.n[a] = air->n[a];
        lattice.origin[a] = air->origin[a] + 0.5 * air->cell;
    }
    TRY(frame_grids_begin(&lattice, out));
    const int *m = out->bricks.n;
    const size_t n = (size_t)m[0] * (size_t)m[1] * (size_t)m[2];
    TRY(memory_alloc(n, sizeof *number, "the wind", &number));
    for (size_t b = 0; b < n; b++)
        number[b] = (uint32_t)b;
    frame_grids_choose(out, &number, n);
done:
    return st;
}

/* Runs BODY for each sample, with `dense`, its index in a dense array, and `at`, its index in the bricks. */
#define EACH_SAMPLE(grids, BODY)                                                                             \
    for (int z = 0; z < (grids)->lattice.n[2]; z++)                                                          \
        for (int y = 0; y < (grids)->lattice.n[1]; y++)                                                      \
            for (int x = 0; x < (grids)->lattice.n[0]; x++) {                                                \
                const size_t dense = place_of(&(grids)->lattice, x, y, z);                                   \
                const ptrdiff_t at = grid_row(grids, x, y, z);                                               \
                BODY                                                                                         \
            }

status air_grid(struct gpu *gpu, const struct wind *w, const struct job *job, int frame,
                struct frame_grids *out)
{
    status st = OK;
    struct wind_lattice air;
    struct frame_grid *grid = NULL;
    float *share = NULL;
    if (!wind_lattice(w, job, frame, &air))
        return OK;
    TRY(begin_whole(&air, out));
    TRY(frame_grids_add(out, VALUE_wind, &grid));
    TRY(memory_alloc(out->bricks.count * BRICK_SAMPLES, 3 * sizeof(float), "the wind", &grid->value));
    TRY(memory_alloc(samples(&out->lattice), 4 * sizeof *share, "the wind", &share));
    TRY(gpu_download(gpu, air.velocity, 0, share, samples(&out->lattice)));
    EACH_SAMPLE(out, {
        for (size_t a = 0; a < 3; a++)
            grid->value[3 * (size_t)at + a] = (float)air.speed * share[4 * dense + a];
    })
done:
    free(share);
    return st;
}

static status upload(struct gpu *gpu, const float *velocity, size_t n, struct aov_air *out)
{
    status st = OK;
    TRY(gpu_buffer_create(gpu, "the wind", n, 16, &out->velocity));
    TRY(gpu_upload(gpu, out->velocity, 0, velocity, n));
done:
    return st;
}

/* Uploads a uniform wind as a single sample. */
static status upload_uniform(struct gpu *gpu, const struct job *job, int frame, struct aov_air *out)
{
    const struct wind_at wind = wind_at(job, frame);
    float velocity[4] = {0};
    for (int a = 0; a < 3; a++)
        velocity[a] = (float)(wind.speed * wind.direction[a]);
    out->lattice = (struct grid_lattice){{1, 1, 1}, 1, {0, 0, 0}};
    return upload(gpu, velocity, 1, out);
}

status air_upload(struct gpu *gpu, const struct frame_grids *air, const struct job *job, int frame,
                  struct aov_air *out)
{
    status st = OK;
    const struct frame_grid *grid = frame_grid_named(air, value_table[VALUE_wind].name);
    float *velocity = NULL;
    *out = (struct aov_air){0};
    if (!grid || grid->components != 3)
        return upload_uniform(gpu, job, frame, out);
    out->lattice = air->lattice;
    TRY(memory_alloc(samples(&air->lattice), 4 * sizeof *velocity, "the wind", &velocity));
    EACH_SAMPLE(air, {
        if (at >= 0)
            memcpy(velocity + 4 * dense, grid->value + 3 * at, 3 * sizeof *velocity);
    })
    TRY(upload(gpu, velocity, samples(&air->lattice), out));
done:
    free(velocity);
    return st;
}

/* ---- checkpoints */

/* The size of the air, which must equal the checkpoint's for its state to be restored. */
enum { AIR_BOX = 4 };

static void air_box(const struct flow *air, double out[AIR_BOX])
{
    const double numbers[AIR_BOX] = {air->spacing, air->box[0], air->box[1], air->box[2]};
    memcpy(out, numbers, sizeof numbers);
}

status air_save(struct gpu *gpu, struct wind *wind, struct checkpoint *out)
{
    status st = OK;
    void *data;
    struct flow *air = &wind->flow;
    struct flow_array array[FLOW_ARRAYS];
    TRY(section_add(out, "air box", 8, AIR_BOX, &data));
    air_box(air, data);
    TRY(section_add(out, "air", 8, sizeof air->state / 8, &data));
    memcpy(data, &air->state, sizeof air->state);
    flow_arrays(air, array);
    for (int i = 0; i < FLOW_ARRAYS; i++) {
        TRY(section_add(out, array[i].name, 4, array[i].n * gpu_buffer_item(array[i].buffer) / 4, &data));
        TRY(gpu_download(gpu, array[i].buffer, 0, data, array[i].n));
    }
done:
    return st;
}

/* Gets the section that is uploaded to an array. */
static status take_array(const struct checkpoint *from, const struct flow_array *array, const void **data)
{
    status st = OK;
    size_t stride = gpu_buffer_item(array->buffer) / 4;
    struct idset ids = {0};
    struct section_rule rule = {
        array->name, array->words ? SECTION_WORD : SECTION_FLOAT, array->n * stride, stride, {{0}}};
    memcpy(rule.range, array->range, sizeof rule.range);
    TRY(section_get(from, &rule, data, NULL));
    if (strcmp(array->name, "air id") == 0)
        TRY(section_check_ids(from, array->name, *data, array->n, UINT64_MAX, &ids));
done:
    idset_free(&ids);
    return st;
}

status air_restore(struct gpu *gpu, struct wind *wind, const struct checkpoint *from)
{
    status st = OK;
    const struct section_rule its_box = {"air box", SECTION_DOUBLE, AIR_BOX, 1, {{0, SECTION_COUNT_MAX}}};
    double box[AIR_BOX];
    const void *data = NULL;
    air_box(&wind->flow, box);
    if (checkpoint_find(from, "air box", 8))
        TRY(section_get(from, &its_box, &data, NULL));
    if (!data || memcmp(data, box, sizeof box) != 0) {
        log_info("frame %d: the checkpoint has no air of this size; the wind starts from still air",
                 from->frame);
        return OK;
    }
    struct flow *air = &wind->flow;
    struct flow_array array[FLOW_ARRAYS];
    /* flow_check() checks the members. */
    TRY(section_get(from,
                    &(struct section_rule){"air", SECTION_INTEGER, sizeof air->state / 8, 1, {SECTION_ALL}},
                    &data, NULL));
    memcpy(&air->state, data, sizeof air->state);
    TRY(flow_check(air));
    flow_arrays(air, array);
    for (int i = 0; i < FLOW_ARRAYS; i++) {
        TRY(take_array(from, &array[i], &data));
        if (array[i].n)
            TRY(gpu_upload(gpu, array[i].buffer, 0, data, array[i].n));
    }
    flow_restore(gpu, air);
done:
    return st;
}
