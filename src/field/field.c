#include "field/field.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"

static struct field geometry(const int voxels[3], double h)
{
    struct field f = {.voxel = h};
    for (int a = 0; a < 3; a++) {
        f.n[a] = voxels[a] + 2 * FIELD_MARGIN;
        f.origin[a] = (0.5 - FIELD_MARGIN) * h;
    }
    return f;
}

static size_t sample_count(const struct field *f)
{
    return (size_t)f->n[0] * (size_t)f->n[1] * (size_t)f->n[2];
}

uint64_t field_bytes(const int voxels[3])
{
    struct field f = geometry(voxels, 1);
    return (uint64_t)sample_count(&f) * (16 + 3 * 4);
}

status field_create(struct gpu *gpu, const int voxels[3], double h, struct field *f)
{
    status st = OK;
    *f = geometry(voxels, h);
    size_t n = sample_count(f);
    TRY(gpu_buffer_create(gpu, "rock share", n, 4, &f->share));
    TRY(gpu_buffer_create(gpu, "field means", n, 16, &f->means));
    TRY(gpu_buffer_create(gpu, "distance", n, 4, &f->distance));
    TRY(gpu_buffer_create(gpu, "distance (other)", n, 4, &f->other));
done:
    if (st != OK)
        field_destroy(gpu, f);
    return st;
}

void field_destroy(struct gpu *gpu, struct field *f)
{
    gpu_buffer_destroy(gpu, &f->share);
    gpu_buffer_destroy(gpu, &f->means);
    gpu_buffer_destroy(gpu, &f->distance);
    gpu_buffer_destroy(gpu, &f->other);
}

static struct field_params params_of(const struct field *f, const struct particles *p)
{
    return (struct field_params){
        .n = (uint)sample_count(f),
        .nx = (uint)p->voxels[0],
        .ny = (uint)p->voxels[1],
        .nz = (uint)p->voxels[2],
        .h = (float)p->h,
        .fx = (uint)f->n[0],
        .fy = (uint)f->n[1],
        .fz = (uint)f->n[2],
        .margin = FIELD_MARGIN,
    };
}

/* What finish() takes the means of, in their order. */
enum { MEANS = 4 };
static const enum value_id means_of[MEANS] = {VALUE_stress, VALUE_von_mises, VALUE_viability, VALUE_deposit};

int field_mean(enum value_id value)
{
    for (int c = 0; c < MEANS; c++)
        if (means_of[c] == value)
            return c;
    return -1;
}

/* Means and distance, from the share. */
static void finish(struct gpu *gpu, struct field *f, struct particles *p)
{
    struct field_params k = params_of(f, p);
    GPU_RUN(gpu, field_means, k.n, k, p->start, p->field[ROCK_stress], p->field[ROCK_von_mises],
            p->field[ROCK_viability], p->field[ROCK_phase], f->share, f->means);
    GPU_RUN(gpu, field_front, k.n, k, f->share, f->distance);
    /* An even number of sweeps, one for each voxel of the band and the rest for its corners. */
    for (int sweep = 0; sweep < FIELD_BAND; sweep++) {
        GPU_RUN(gpu, field_distance, k.n, k, f->distance, f->other);
        GPU_RUN(gpu, field_distance, k.n, k, f->other, f->distance);
    }
}

void field_build(struct gpu *gpu, struct field *f, struct particles *p)
{
    struct field_params k = params_of(f, p);
    particles_fill(gpu, p);
    GPU_RUN(gpu, field_share, k.n, k, p->fill, f->share);
    finish(gpu, f, p);
}

status field_build_share(struct gpu *gpu, struct field *f, struct particles *p, const float *share)
{
    status st = gpu_upload(gpu, f->share, 0, share, sample_count(f));
    if (st == OK)
        finish(gpu, f, p);
    return st;
}

/* Means over the surface's particles. `other` is free once the distances are there. */
static status download_skin(struct gpu *gpu, struct field *f, struct particles *p, enum value_id which,
                            float *out)
{
    const struct field_params k = params_of(f, p);
    GPU_RUN(gpu, field_skin, k.n, k, p->start, p->field[ROCK_N], p->field[value_field[which]], f->share,
            f->other);
    return gpu_download(gpu, f->other, 0, out, k.n);
}

static status download_value(struct gpu *gpu, struct field *f, struct particles *p, const float *means,
                             enum value_id which, float *out)
{
    status st = OK;
    const size_t n = sample_count(f);
    const int component = field_mean(which);
    switch (value_table[which].from) {
    case FROM_DISTANCE:
        return gpu_download(gpu, f->distance, 0, out, n);
    case FROM_SHARE:
        TRY(gpu_download(gpu, f->share, 0, out, n));
        for (size_t i = 0; i < n; i++)
            out[i] = fminf(out[i], 1);
        break;
    case FROM_MEANS:
        for (size_t i = 0; component >= 0 && i < n; i++)
            out[i] = means[4 * i + (size_t)component];
        break;
    default:
        return download_skin(gpu, f, p, which, out);
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

status field_download(struct gpu *gpu, struct field *f, struct particles *p, unsigned has,
                      struct frame_grids *out)
{
    status st = OK;
    size_t n = sample_count(f);
    float *means = NULL;
    *out = (struct frame_grids){.voxel = f->voxel};
    for (int a = 0; a < 3; a++) {
        out->n[a] = f->n[a];
        out->origin[a] = f->origin[a];
    }
    TRY(memory_alloc(4 * n, sizeof(float), "field means", &means));
    TRY(gpu_download(gpu, f->means, 0, means, n));
    for (int v = 1; v < VALUES; v++) {
        struct frame_grid *grid;
        if (!makes((enum value_id)v, has))
            continue;
        TRY(frame_grids_add(out, (enum value_id)v, &grid));
        TRY(memory_alloc(n, sizeof(float), grid->name, &grid->value));
        TRY(download_value(gpu, f, p, means, (enum value_id)v, grid->value));
    }
done:
    free(means);
    if (st != OK)
        field_grids_free(out);
    return st;
}

static const float *grid_named(const struct frame_grids *grids, const char *name)
{
    for (size_t g = 0; g < grids->n_grids; g++)
        if (strcmp(grids->grid[g].name, name) == 0 && grids->grid[g].own.n[0] == 0)
            return grids->grid[g].value;
    return NULL;
}

status field_upload(struct gpu *gpu, struct field *f, const struct frame_grids *grids)
{
    const float *surface = grid_named(grids, value_table[VALUE_surface].name);
    size_t n = sample_count(f);
    float *means = NULL;
    status st = OK;
    if (!surface)
        return fail(E_INPUT, "it has no grid 'surface'");
    for (int a = 0; a < 3; a++)
        if (grids->n[a] != f->n[a] || fabs(grids->origin[a] - f->origin[a]) > 1e-3 * f->voxel)
            return fail(E_INPUT, "its grids have %d x %d x %d voxels, and the job's %d x %d x %d",
                        grids->n[0], grids->n[1], grids->n[2], f->n[0], f->n[1], f->n[2]);
    TRY(memory_alloc(4 * n, sizeof *means, "field means", &means));
    for (size_t c = 0; c < MEANS; c++) {
        const float *from = grid_named(grids, value_table[means_of[c]].name);
        for (size_t i = 0; from && i < n; i++)
            means[4 * i + c] = from[i];
    }
    TRY(gpu_upload(gpu, f->means, 0, means, n));
    TRY(gpu_upload(gpu, f->distance, 0, surface, n));
done:
    free(means);
    return st;
}

void field_grids_free(struct frame_grids *grids)
{
    for (size_t g = 0; g < grids->n_grids; g++)
        free(grids->grid[g].value);
    memset(grids, 0, sizeof *grids);
}
