/* Downloads the field as grids (particles/grids.h) and uploads it again. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "field/field.h"

/* Bricks whose means are transferred at a time. */
enum { TOGETHER = 2048 };

static size_t chunk_of(size_t count, size_t first)
{
    return (count - first < TOGETHER ? count - first : TOGETHER) * BRICK_SAMPLES;
}

/* Transfer buffer for the means of a few bricks. */
static status chunk_create(size_t count, float **out)
{
    return memory_alloc(FIELD_MEANS * chunk_of(count, 0), sizeof **out, "field means", out);
}

/* ---- download */

static status download_bricks(struct gpu *gpu, const struct field *f, struct frame_grids *out)
{
    status st = OK;
    uint32_t *number = NULL;
    TRY(memory_alloc(f->n_bricks, sizeof *number, "bricks", &number));
    if (f->n_bricks)
        TRY(gpu_download(gpu, f->list, 0, number, f->n_bricks));
    frame_grids_choose(out, &number, f->n_bricks);
    TRY(gpu_download(gpu, f->slot, 0, out->bricks.slot, gpu_buffer_count(f->slot)));
done:
    free(number);
    return st;
}

/* The grids of the means' four components; NULL: not wanted. */
struct mean_grids {
    float *value[FIELD_MEANS];
};

/* Downloads all components together, so that the means are transferred once. */
static status download_means(struct gpu *gpu, const struct field *f, const struct mean_grids *to)
{
    status st = OK;
    float *chunk = NULL;
    TRY(chunk_create(f->n_bricks, &chunk));
    for (size_t first = 0; first < f->n_bricks; first += TOGETHER) {
        const size_t n = chunk_of(f->n_bricks, first);
        TRY(gpu_download(gpu, f->means, first * BRICK_SAMPLES, chunk, n));
        for (size_t c = 0; c < FIELD_MEANS; c++)
            for (size_t i = 0; to->value[c] && i < n; i++)
                to->value[c][first * BRICK_SAMPLES + i] = chunk[FIELD_MEANS * i + c];
    }
done:
    free(chunk);
    return st;
}

/* Downloads a grid that is not one of the means. */
static status download_value(struct gpu *gpu, struct field *f, struct particles *p, enum value_id which,
                             float *out)
{
    status st = OK;
    const size_t n = f->n_bricks * BRICK_SAMPLES;
    float *plane = NULL;
    if (n == 0)
        return OK;
    if (value_table[which].from == FROM_AROUND)
        TRY(memory_alloc(n, sizeof *plane, value_table[which].name, &plane));
    switch (value_table[which].from) {
    case FROM_DISTANCE:
        return gpu_download(gpu, f->distance, 0, out, n);
    case FROM_SHARE:
        TRY(gpu_download(gpu, f->share, 0, out, n));
        for (size_t i = 0; i < n; i++)
            out[i] = fminf(out[i], 1);
        break;
    case FROM_AROUND:
        for (int c = 0; c < 3 && p->field[value_field[which]]; c++) {
            field_around(gpu, f, p, which, c);
            TRY(gpu_download(gpu, f->other, 0, plane, n));
            for (size_t i = 0; i < n; i++)
                out[3 * i + (size_t)c] = plane[i];
        }
        break;
    default: /* means over the surface particles; `other` is free after the distances have been computed */
        field_skin(gpu, f, p, which);
        TRY(gpu_download(gpu, f->other, 0, out, n));
    }
done:
    free(plane);
    return st;
}

/* Is it made from the field? Grids of wind and terrain are added by their owners. */
static bool makes(enum value_id which, unsigned has)
{
    const struct value *v = &value_table[which];
    return (v->where & IN_VOLUMES) && (v->has & has) && v->from != FROM_AIR && v->from != FROM_TERRAIN;
}

status field_download(struct gpu *gpu, struct field *f, struct particles *p, unsigned has,
                      struct frame_grids *out)
{
    status st = OK;
    struct mean_grids means = {0};
    struct grid_lattice lattice = {.voxel = f->voxel};
    memcpy(lattice.n, f->n, sizeof lattice.n);
    memcpy(lattice.origin, f->origin, sizeof lattice.origin);
    TRY(frame_grids_begin(&lattice, out));
    TRY(download_bricks(gpu, f, out));
    for (int v = 1; v < VALUES; v++) {
        struct frame_grid *grid;
        if (!makes((enum value_id)v, has))
            continue;
        TRY(frame_grids_add(out, (enum value_id)v, &grid));
        TRY(memory_alloc(f->n_bricks * BRICK_SAMPLES, (size_t)grid->components * sizeof *grid->value,
                         grid->name, &grid->value));
        if (field_mean((enum value_id)v) >= 0)
            means.value[field_mean((enum value_id)v)] = grid->value;
        else
            TRY(download_value(gpu, f, p, (enum value_id)v, grid->value));
    }
    TRY(download_means(gpu, f, &means));
done:
    if (st != OK)
        frame_grids_free(out);
    return st;
}

/* ---- upload */

/* Uploads the means from the grids that exist. */
static status upload_means(struct gpu *gpu, struct field *f, const struct frame_grids *grids)
{
    status st = OK;
    float *chunk = NULL;
    TRY(chunk_create(f->n_bricks, &chunk));
    for (size_t first = 0; first < f->n_bricks; first += TOGETHER) {
        const size_t n = chunk_of(f->n_bricks, first);
        memset(chunk, 0, FIELD_MEANS * n * sizeof *chunk);
        for (int v = 1; v < VALUES; v++) {
            const int component = field_mean((enum value_id)v);
            const struct frame_grid *grid =
                component < 0 ? NULL : frame_grid_named(grids, value_table[v].name);
            for (size_t i = 0; grid && i < n; i++)
                chunk[FIELD_MEANS * i + (size_t)component] = grid->value[first * BRICK_SAMPLES + i];
        }
        TRY(gpu_upload(gpu, f->means, first * BRICK_SAMPLES, chunk, n));
    }
done:
    free(chunk);
    return st;
}

status field_upload(struct gpu *gpu, struct field *f, const struct frame_grids *grids)
{
    status st = OK;
    const struct frame_grid *surface = frame_grid_named(grids, value_table[VALUE_surface].name);
    const struct grid_lattice *l = &grids->lattice;
    const size_t n = grids->bricks.count;
    if (!surface)
        return fail(E_INPUT, "it has no grid 'surface'");
    for (int a = 0; a < 3; a++)
        if (l->n[a] != f->n[a] || fabs(l->origin[a] - f->origin[a]) > 1e-3 * f->voxel)
            return fail(E_INPUT, "its grids have %d x %d x %d voxels, and the job's %d x %d x %d", l->n[0],
                        l->n[1], l->n[2], f->n[0], f->n[1], f->n[2]);
    if (n)
        TRY(gpu_upload(gpu, f->list, 0, grids->bricks.number, n));
    TRY(field_keep(gpu, f, n));
    TRY(gpu_upload(gpu, f->slot, 0, grids->bricks.slot, gpu_buffer_count(f->slot)));
    if (n)
        TRY(gpu_upload(gpu, f->distance, 0, surface->value, n * BRICK_SAMPLES));
    TRY(upload_means(gpu, f, grids));
    TRY(gpu_wait(gpu));
done:
    return st;
}
