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

static status flow_grid(struct gpu *gpu, const struct wind_lattice *air, struct frame_grid *out)
{
    status st = OK;
    float *share = NULL;
    out->own.voxel = air->cell;
    for (int a = 0; a < 3; a++) {
        out->own.n[a] = air->n[a];
        out->own.origin[a] = air->origin[a] + 0.5 * air->cell;
    }
    size_t n = samples(&out->own);
    TRY(memory_alloc(n, 4 * sizeof *share, "the wind", &share));
    TRY(memory_alloc(n, 3 * sizeof *share, "the wind", &out->value));
    TRY(gpu_download(gpu, air->velocity, 0, share, n));
    for (size_t i = 0; i < n; i++)
        for (size_t a = 0; a < 3; a++)
            out->value[3 * i + a] = (float)air->speed * share[4 * i + a];
done:
    free(share);
    return st;
}

status air_add(struct gpu *gpu, const struct wind *w, const struct job *job, int frame,
               struct frame_grids *grids)
{
    struct wind_lattice air;
    struct frame_grid *out;
    status st = OK;
    if (!wind_lattice(w, job, frame, &air))
        return OK;
    TRY(frame_grids_add(grids, VALUE_vel, &out));
    TRY(flow_grid(gpu, &air, out));
done:
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

/* One sample, which is the same everywhere. */
static status upload_uniform(struct gpu *gpu, const struct job *job, int frame, struct aov_air *out)
{
    const struct wind_at wind = wind_at(job, frame);
    float velocity[4] = {0};
    for (int a = 0; a < 3; a++)
        velocity[a] = (float)(wind.speed * wind.direction[a]);
    out->lattice = (struct grid_lattice){{1, 1, 1}, 1, {0, 0, 0}};
    return upload(gpu, velocity, 1, out);
}

status air_upload(struct gpu *gpu, const struct frame_grids *grids, const struct job *job, int frame,
                  struct aov_air *out)
{
    status st = OK;
    float *velocity = NULL;
    *out = (struct aov_air){0};
    for (size_t g = 0; g < grids->n_grids; g++) {
        const struct frame_grid *grid = &grids->grid[g];
        if (strcmp(grid->name, value_table[VALUE_vel].name) != 0 || grid->own.n[0] == 0 ||
            grid->components != 3)
            continue;
        size_t n = samples(&grid->own);
        TRY(memory_alloc(n, 4 * sizeof *velocity, "the wind", &velocity));
        for (size_t i = 0; i < n; i++)
            memcpy(velocity + 4 * i, grid->value + 3 * i, 3 * sizeof *velocity);
        out->lattice = grid->own;
        st = upload(gpu, velocity, n, out);
        goto done;
    }
    TRY(upload_uniform(gpu, job, frame, out));
done:
    free(velocity);
    return st;
}

/* ---- checkpoints */

/* What air has to have in common with a checkpoint's to go on from it. */
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

/* What gets uploaded to the arrays of that name. */
static status take_array(const struct checkpoint *from, const struct flow_array *array, const void **data)
{
    status st = OK;
    size_t stride = gpu_buffer_item(array->buffer) / 4;
    struct idset ids = {0};
    struct section_rule rule = {
        array->name, array->words ? SECTION_WORD : SECTION_FLOAT, array->n * stride, stride, {{0}}};
    memcpy(rule.range, array->range, sizeof rule.range);
    TRY(section_take(from, &rule, data, NULL));
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
        TRY(section_take(from, &its_box, &data, NULL));
    if (!data || memcmp(data, box, sizeof box) != 0) {
        log_info("frame %d: the checkpoint has no air of this size: it begins anew", from->frame);
        return OK;
    }
    struct flow *air = &wind->flow;
    struct flow_array array[FLOW_ARRAYS];
    /* Its members are checked by flow_check(). */
    TRY(section_take(from,
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
