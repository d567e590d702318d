/* The field to the host and back, by bricks (particles/grids.h). */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "field/field.h"

/* Bricks that are on their way at a time. */
enum { TOGETHER = 2048 };

/* A list of bricks on the device, and room for the samples of a few. */
struct transfer {
    struct gpu_buffer *list, *chunk;
    struct field_brick_params k;
};

static void transfer_end(struct gpu *gpu, struct transfer *t)
{
    gpu_buffer_destroy(gpu, &t->list);
    gpu_buffer_destroy(gpu, &t->chunk);
}

static struct field_brick_params params_of(const struct field *f)
{
    int bricks[3];
    grid_bricks_of(f->n, bricks);
    return (struct field_brick_params){
        .fx = (uint)f->n[0],
        .fy = (uint)f->n[1],
        .fz = (uint)f->n[2],
        .bx = (uint)bricks[0],
        .by = (uint)bricks[1],
        .bz = (uint)bricks[2],
        .background = (float)(FIELD_BAND * f->voxel),
    };
}

static status transfer_begin(struct gpu *gpu, const struct field *f, const struct grid_bricks *bricks,
                             struct transfer *t)
{
    status st = OK;
    const size_t together = bricks->count < TOGETHER ? bricks->count : TOGETHER;
    t->k = params_of(f);
    TRY(gpu_buffer_create(gpu, "bricks", bricks->count + 1, 4, &t->list));
    TRY(gpu_buffer_create(gpu, "samples of bricks", (together + 1) * BRICK_SAMPLES, 4, &t->chunk));
    if (bricks->count)
        TRY(gpu_upload(gpu, t->list, 0, bricks->number, bricks->count));
done:
    return st;
}

static size_t chunk_of(size_t count, size_t first)
{
    return count - first < TOGETHER ? count - first : TOGETHER;
}

/* ---- to the host */

/* Which bricks hold anything. */
static status choose(struct gpu *gpu, struct gpu_work *work, const struct field *f, struct frame_grids *out)
{
    status st = OK;
    struct gpu_buffer *held = NULL, *place = NULL, *list = NULL;
    struct field_brick_params k = params_of(f);
    uint32_t *number = NULL;
    size_t count = 0;
    k.n = k.bx * k.by * k.bz;
    TRY(gpu_buffer_create(gpu, "bricks", k.n, 4, &held));
    TRY(gpu_buffer_create(gpu, "bricks", k.n, 4, &place));
    TRY(gpu_buffer_create(gpu, "bricks", k.n, 4, &list));
    GPU_RUN(gpu, field_held, k.n, k, f->distance, f->share, held);
    TRY(gpu_compact(gpu, work, held, place, list, k.n, &count));
    TRY(memory_alloc(count, sizeof *number, "bricks", &number));
    if (count)
        TRY(gpu_download(gpu, list, 0, number, count));
    frame_grids_choose(out, &number, count);
done:
    free(number);
    gpu_buffer_destroy(gpu, &held);
    gpu_buffer_destroy(gpu, &place);
    gpu_buffer_destroy(gpu, &list);
    return st;
}

/* The samples of `from`: floats, or a component of the means. */
static status take(struct gpu *gpu, struct transfer *t, struct gpu_buffer *from, int component,
                   float background, size_t count, float *out)
{
    status st = OK;
    struct field_brick_params k = t->k;
    k.background = background;
    k.component = (uint)component;
    for (size_t first = 0; first < count; first += TOGETHER) {
        const size_t n = chunk_of(count, first) * BRICK_SAMPLES;
        k.n = (uint)n;
        k.first = (uint)first;
        if (component < 0)
            GPU_RUN(gpu, field_take, k.n, k, t->list, from, t->chunk);
        else
            GPU_RUN(gpu, field_take_mean, k.n, k, t->list, from, t->chunk);
        TRY(gpu_download(gpu, t->chunk, 0, out + first * BRICK_SAMPLES, n));
    }
done:
    return st;
}

static status download_value(struct gpu *gpu, struct transfer *t, struct field *f, struct particles *p,
                             enum value_id which, const struct frame_grids *grids, struct frame_grid *grid)
{
    status st = OK;
    const size_t count = grids->bricks.count, n = count * BRICK_SAMPLES;
    const float background = grid_background(grids, grid);
    TRY(memory_alloc(n, sizeof(float), grid->name, &grid->value));
    switch (value_table[which].from) {
    case FROM_DISTANCE:
        TRY(take(gpu, t, f->distance, -1, background, count, grid->value));
        break;
    case FROM_SHARE:
        TRY(take(gpu, t, f->share, -1, background, count, grid->value));
        for (size_t i = 0; i < n; i++)
            grid->value[i] = fminf(grid->value[i], 1);
        break;
    case FROM_MEANS:
        TRY(take(gpu, t, f->means, field_mean(which), background, count, grid->value));
        break;
    default: /* means over the surface's particles. `other` is free once the distances are there */
        field_skin(gpu, f, p, which);
        TRY(take(gpu, t, f->other, -1, background, count, grid->value));
    }
done:
    return st;
}

/* Whether it is the field's to make: wind and terrain are added by whoever has them. */
static bool makes(enum value_id which, unsigned has)
{
    const struct value *v = &value_table[which];
    return (v->where & IN_VOLUMES) && (v->has & has) && v->from != FROM_AIR && v->from != FROM_TERRAIN;
}

status field_download(struct gpu *gpu, struct gpu_work *work, struct field *f, struct particles *p,
                      unsigned has, struct frame_grids *out)
{
    status st = OK;
    struct transfer t = {0};
    struct grid_lattice lattice = {.voxel = f->voxel};
    memcpy(lattice.n, f->n, sizeof lattice.n);
    memcpy(lattice.origin, f->origin, sizeof lattice.origin);
    TRY(frame_grids_begin(&lattice, out));
    TRY(choose(gpu, work, f, out));
    TRY(transfer_begin(gpu, f, &out->bricks, &t));
    for (int v = 1; v < VALUES; v++) {
        struct frame_grid *grid;
        if (!makes((enum value_id)v, has))
            continue;
        TRY(frame_grids_add(out, (enum value_id)v, &grid));
        TRY(download_value(gpu, &t, f, p, (enum value_id)v, out, grid));
    }
done:
    transfer_end(gpu, &t);
    if (st != OK)
        frame_grids_free(out);
    return st;
}

/* ---- and back */

static status put(struct gpu *gpu, struct transfer *t, const struct frame_grid *grid, size_t count,
                  struct gpu_buffer *to, int component)
{
    status st = OK;
    struct field_brick_params k = t->k;
    k.component = (uint)component;
    for (size_t first = 0; first < count; first += TOGETHER) {
        const size_t n = chunk_of(count, first) * BRICK_SAMPLES;
        k.n = (uint)n;
        k.first = (uint)first;
        TRY(gpu_upload(gpu, t->chunk, 0, grid->value + first * BRICK_SAMPLES, n));
        if (component < 0)
            GPU_RUN(gpu, field_put, k.n, k, t->list, t->chunk, to);
        else
            GPU_RUN(gpu, field_put_mean, k.n, k, t->list, t->chunk, to);
    }
done:
    return st;
}

static uint32_t word_of(float value)
{
    uint32_t word;
    memcpy(&word, &value, sizeof word);
    return word;
}

status field_upload(struct gpu *gpu, struct field *f, const struct frame_grids *grids)
{
    status st = OK;
    const struct frame_grid *surface = frame_grid_named(grids, value_table[VALUE_surface].name);
    const struct grid_lattice *l = &grids->lattice;
    const size_t count = grids->bricks.count;
    struct transfer t = {0};
    if (!surface)
        return fail(E_INPUT, "it has no grid 'surface'");
    for (int a = 0; a < 3; a++)
        if (l->n[a] != f->n[a] || fabs(l->origin[a] - f->origin[a]) > 1e-3 * f->voxel)
            return fail(E_INPUT, "its grids have %d x %d x %d voxels, and the job's %d x %d x %d", l->n[0],
                        l->n[1], l->n[2], f->n[0], f->n[1], f->n[2]);
    TRY(transfer_begin(gpu, f, &grids->bricks, &t));
    gpu_fill(gpu, f->distance, word_of(t.k.background));
    gpu_fill(gpu, f->means, 0);
    TRY(put(gpu, &t, surface, count, f->distance, -1));
    for (int v = 1; v < VALUES; v++) {
        const int component = field_mean((enum value_id)v);
        const struct frame_grid *grid = component < 0 ? NULL : frame_grid_named(grids, value_table[v].name);
        if (grid)
            TRY(put(gpu, &t, grid, count, f->means, component));
    }
    TRY(gpu_wait(gpu));
done:
    transfer_end(gpu, &t);
    return st;
}
