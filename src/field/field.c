#include "field/field.h"

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

void field_skin(struct gpu *gpu, struct field *f, struct particles *p, enum value_id which)
{
    const struct field_params k = params_of(f, p);
    GPU_RUN(gpu, field_skin, k.n, k, p->start, p->field[ROCK_N], p->field[value_field[which]], f->share,
            f->other);
}
