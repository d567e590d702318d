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

/* `other` is free once the distances are there. */
static status download_skin(struct gpu *gpu, struct field *f, struct particles *p, enum rock_field which,
                            struct frame_grid *out)
{
    const struct field_params k = params_of(f, p);
    status st = OK;
    *out = (struct frame_grid){
        .name = rock_field_table[which].name, .unit = rock_field_table[which].unit, .kind = GRID_PLAIN};
    TRY(memory_alloc(k.n, sizeof(float), out->name, &out->value));
    GPU_RUN(gpu, field_skin, k.n, k, p->start, p->field[ROCK_N], p->field[which], f->share, f->other);
    TRY(gpu_download(gpu, f->other, 0, out->value, k.n));
done:
    return st;
}

status field_download(struct gpu *gpu, struct field *f, struct particles *p, const enum rock_field *skin,
                      size_t n_skin, struct frame_grids *out)
{
    static const struct frame_grid kinds[] = {
        {.name = "surface", .unit = "m", .kind = GRID_LEVEL_SET},
        {.name = "density", .unit = "", .kind = GRID_FOG},
        {.name = "stress", .unit = "Pa", .kind = GRID_PLAIN},
        {.name = "von_mises", .unit = "Pa", .kind = GRID_PLAIN},
        {.name = "viability", .unit = "", .kind = GRID_PLAIN},
    };
    status st = OK;
    size_t n = sample_count(f);
    float *means = NULL;
    *out = (struct frame_grids){.voxel = f->voxel, .n_grids = sizeof kinds / sizeof *kinds};
    for (int a = 0; a < 3; a++) {
        out->n[a] = f->n[a];
        out->origin[a] = f->origin[a];
    }
    for (size_t g = 0; g < out->n_grids; g++) {
        out->grid[g] = kinds[g];
        TRY(memory_alloc(n, sizeof(float), kinds[g].name, &out->grid[g].value));
    }
    TRY(memory_alloc(4 * n, sizeof(float), "field means", &means));
    TRY(gpu_download(gpu, f->distance, 0, out->grid[0].value, n));
    TRY(gpu_download(gpu, f->share, 0, out->grid[1].value, n));
    TRY(gpu_download(gpu, f->means, 0, means, n));
    float *density = out->grid[1].value, *stress = out->grid[2].value, *mises = out->grid[3].value,
          *viability = out->grid[4].value;
    for (size_t i = 0; i < n; i++) {
        density[i] = fminf(density[i], 1);
        stress[i] = means[4 * i];
        mises[i] = means[4 * i + 1];
        viability[i] = means[4 * i + 2];
    }
    for (size_t s = 0; s < n_skin; s++) {
        struct frame_grid *grid = &out->grid[out->n_grids++];
        if (skin[s] != ROCK_phase) {
            TRY(download_skin(gpu, f, p, skin[s], grid));
            continue;
        }
        *grid = (struct frame_grid){.name = "deposit", .unit = "", .kind = GRID_PLAIN};
        TRY(memory_alloc(n, sizeof(float), grid->name, &grid->value));
        for (size_t i = 0; i < n; i++)
            grid->value[i] = means[4 * i + 3];
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
    static const char *const names[4] = {"stress", "von_mises", "viability", "deposit"};
    const float *surface = grid_named(grids, "surface");
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
    for (size_t c = 0; c < 4; c++) {
        const float *from = grid_named(grids, names[c]);
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
