/* Downloads the field as grids (particles/grids.h) and uploads it again. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "field/field.h"

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

/* A vector's components are computed one after the other. */
static status read_vector(struct gpu *gpu, struct field *f, const struct particles *p, enum value_id which,
                          size_t n, float *out)
{
    status st = OK;
    float *plane = NULL;
    TRY(memory_alloc(n, sizeof *plane, value_table[which].name, &plane));
    for (int c = 0; c < 3 && p->field[value_field[which]]; c++) {
        field_around(gpu, f, p, which, c);
        TRY(gpu_download(gpu, f->other, 0, plane, n));
        for (size_t i = 0; i < n; i++)
            out[3 * i + (size_t)c] = plane[i];
    }
done:
    free(plane);
    return st;
}

/* Once the distances have been computed, `other` is free for values that are not in a buffer of their own. */
status field_read(struct gpu *gpu, struct field *f, const struct particles *p, enum value_id which,
                  float *out)
{
    status st = OK;
    const size_t n = f->n_bricks * BRICK_SAMPLES;
    if (n == 0)
        return OK;
    switch (value_table[which].from) {
    case FROM_DISTANCE:
        return gpu_download(gpu, f->distance, 0, out, n);
    case FROM_SHARE:
        TRY(gpu_download(gpu, f->share, 0, out, n));
        for (size_t i = 0; i < n; i++)
            out[i] = fminf(out[i], 1);
        return OK;
    case FROM_AROUND:
        return read_vector(gpu, f, p, which, n, out);
    case FROM_MEANS:
        field_one_mean(gpu, f, field_mean(which));
        break;
    default: /* means over the surface particles */
        field_skin(gpu, f, p, which);
    }
    TRY(gpu_download(gpu, f->other, 0, out, n));
done:
    return st;
}

/* Is it made from the field? Grids of wind and terrain are added by their owners. */
static bool makes(enum value_id which, unsigned has)
{
    const struct value *v = &value_table[which];
    return (v->where & IN_VOLUMES) && (v->has & has) && v->from != FROM_AIR && v->from != FROM_TERRAIN;
}

status field_grids(struct gpu *gpu, const struct field *f, unsigned has, struct frame_grids *out)
{
    status st = OK;
    struct grid_lattice lattice = {.voxel = f->voxel};
    memcpy(lattice.n, f->n, sizeof lattice.n);
    memcpy(lattice.origin, f->origin, sizeof lattice.origin);
    TRY(frame_grids_begin(&lattice, out));
    TRY(download_bricks(gpu, f, out));
    for (int v = 1; v < VALUES; v++) {
        struct frame_grid *grid;
        if (makes((enum value_id)v, has))
            TRY(frame_grids_add(out, (enum value_id)v, &grid));
    }
done:
    if (st != OK)
        frame_grids_free(out);
    return st;
}

/* ---- upload */

/* Bricks whose means are transferred at a time. */
enum { TOGETHER = 2048 };

static size_t chunk_of(size_t count, size_t first)
{
    return (count - first < TOGETHER ? count - first : TOGETHER) * BRICK_SAMPLES;
}

/* Uploads the means from the grids that exist. */
static status upload_means(struct gpu *gpu, struct field *f, const struct frame_grids *grids)
{
    status st = OK;
    float *chunk = NULL;
    TRY(memory_alloc(FIELD_MEANS * chunk_of(f->n_bricks, 0), sizeof *chunk, "field means", &chunk));
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
