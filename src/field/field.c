#include "field/field.h"

#include <math.h>
#include <stdlib.h>

#include "base/memory.h"
#include "particles/deep.h"

static struct field geometry(const int voxels[3], double h)
{
    struct field f = {.voxel = h};
    for (int a = 0; a < 3; a++) {
        f.n[a] = voxels[a] + 2 * FIELD_MARGIN;
        f.origin[a] = (0.5 - FIELD_MARGIN) * h;
    }
    return f;
}

static size_t all_bricks(const struct field *f)
{
    int bricks[3];
    return grid_bricks_of(f->n, bricks);
}

/* Bytes per sample: share, distance, other, means. */
enum { SAMPLE_BYTES = 3 * 4 + 16 };

/* The first allocation is exact; later ones are larger, so that growing rock does not reallocate in each frame. */
static size_t room_for(const struct field *f, size_t bricks)
{
    return bricks + (f->room > 1 ? bricks / 8 : 0) + 1;
}

uint64_t field_bytes(const int voxels[3], uint64_t samples)
{
    struct field f = geometry(voxels, 1);
    return (uint64_t)all_bricks(&f) * 4 * 4 +
           (uint64_t)room_for(&f, samples / BRICK_SAMPLES) * BRICK_SAMPLES * SAMPLE_BYTES;
}

status field_create(struct gpu *gpu, const int voxels[3], double h, struct field *f)
{
    status st = OK;
    *f = geometry(voxels, h);
    const size_t n = all_bricks(f);
    TRY(gpu_buffer_create(gpu, "slots of bricks", n, 4, &f->slot));
    TRY(gpu_buffer_create(gpu, "bricks", n, 4, &f->list));
    TRY(gpu_buffer_create(gpu, "held bricks", n, 4, &f->held));
    TRY(gpu_buffer_create(gpu, "places of bricks", n, 4, &f->place));
    TRY(field_keep(gpu, f, 0));
done:
    if (st != OK)
        field_destroy(gpu, f);
    return st;
}

static void destroy_samples(struct gpu *gpu, struct field *f)
{
    gpu_buffer_destroy(gpu, &f->share);
    gpu_buffer_destroy(gpu, &f->means);
    gpu_buffer_destroy(gpu, &f->distance);
    gpu_buffer_destroy(gpu, &f->other);
    f->room = 0;
}

void field_destroy(struct gpu *gpu, struct field *f)
{
    destroy_samples(gpu, f);
    gpu_buffer_destroy(gpu, &f->slot);
    gpu_buffer_destroy(gpu, &f->list);
    gpu_buffer_destroy(gpu, &f->held);
    gpu_buffer_destroy(gpu, &f->place);
}

static struct field_params params_of(const struct field *f, const struct particles *p)
{
    return (struct field_params){
        .n = (uint)(f->n_bricks * BRICK_SAMPLES),
        .nx = (uint)p->voxels[0],
        .ny = (uint)p->voxels[1],
        .nz = (uint)p->voxels[2],
        .h = (float)p->h,
        .fx = (uint)f->n[0],
        .fy = (uint)f->n[1],
        .fz = (uint)f->n[2],
        .margin = FIELD_MARGIN,
        .walls = p->walls,
    };
}

/* The values whose means finish() computes, in the order of components. */
static const enum value_id means_of[FIELD_MEANS] = {VALUE_stress, VALUE_von_mises, VALUE_viability,
                                                    VALUE_deposit};

int field_mean(enum value_id value)
{
    for (int c = 0; c < FIELD_MEANS; c++)
        if (means_of[c] == value)
            return c;
    return -1;
}

bool field_cut_near(const struct field_cut *cut, int axis, double origin, double voxel, int first, int last)
{
    const double at = (cut->at - origin) / voxel;
    return cut->keeps != CUT_NONE && axis == cut->axis && at >= first - CUT_REACH && at <= last + CUT_REACH;
}

/* ---- bricks */

status field_keep(struct gpu *gpu, struct field *f, size_t n)
{
    status st = OK;
    if (n > f->room || f->room == 0) {
        const size_t room = room_for(f, n), samples = room * BRICK_SAMPLES;
        destroy_samples(gpu, f);
        TRY(gpu_buffer_create(gpu, "rock share", samples, 4, &f->share));
        TRY(gpu_buffer_create(gpu, "field means", samples, 16, &f->means));
        TRY(gpu_buffer_create(gpu, "distance", samples, 4, &f->distance));
        TRY(gpu_buffer_create(gpu, "distance (other)", samples, 4, &f->other));
        f->room = room;
    }
    f->n_bricks = n;
done:
    return st;
}

/* Parameters for a grid of `n` samples, the first of which is the field's sample `margin`. */
static struct field_params extent_params(const struct field *f, const int n[3], int margin)
{
    return (struct field_params){.n = (uint)all_bricks(f),
                                 .nx = (uint)n[0],
                                 .ny = (uint)n[1],
                                 .nz = (uint)n[2],
                                 .h = (float)f->voxel,
                                 .fx = (uint)f->n[0],
                                 .fy = (uint)f->n[1],
                                 .fz = (uint)f->n[2],
                                 .margin = (uint)margin};
}

/* Treats bricks at the cut as if they were at the surface, so that they are stored. */
static status expose_cut(struct gpu *gpu, struct field *f)
{
    status st = OK;
    uint32_t *bare = NULL;
    int bricks[3];
    const size_t n = grid_bricks_of(f->n, bricks);
    const int axis = f->cut.axis;
    TRY(memory_alloc(n, sizeof *bare, "bricks", &bare));
    TRY(gpu_download(gpu, f->list, 0, bare, n));
    for (size_t b = 0; b < n; b++) {
        const size_t across = (size_t)bricks[0],
                     x[3] = {b % across, b / across % (size_t)bricks[1], b / across / (size_t)bricks[1]};
        const int first = BRICK_SIDE * (int)x[axis];
        if (field_cut_near(&f->cut, axis, f->origin[axis], f->voxel, first, first + BRICK_SIDE - 1))
            bare[b] = EXTENT_ALL;
    }
    TRY(gpu_upload(gpu, f->list, 0, bare, n));
done:
    free(bare);
    return st;
}

/* Lists the bricks near the surface, which is between voxels with rock and voxels that are not full. The extents of both in each brick are in
 * f->place and f->list. */
static status choose(struct gpu *gpu, struct gpu_work *work, struct field *f)
{
    status st = OK;
    size_t count;
    const size_t all = all_bricks(f);
    const struct field_params k = extent_params(f, f->n, 0);
    GPU_RUN(gpu, field_held, k.n, k, f->place, f->list, f->held, f->slot);
    TRY(gpu_compact(gpu, work, f->held, f->place, f->list, all, &count));
    TRY(field_keep(gpu, f, count));
    const struct count_params each = {(uint)count};
    if (count)
        GPU_RUN(gpu, field_slots, each.n, each, f->list, f->slot);
done:
    return st;
}

/* ---- samples */

/* Computes means and distance from the share, which is finally cut off at walls. */
static void finish(struct gpu *gpu, struct field *f, struct particles *p)
{
    struct field_params k = params_of(f, p);
    if (k.n == 0)
        return;
    if (f->whole || f->cut.keeps != CUT_NONE)
        gpu_fill(gpu, p->place, ~0U);
    else
        particles_mark_near(gpu, p, NEAR_REACH);
    GPU_RUN(gpu, field_means, k.n, k, p->held.words, p->start, p->field[ROCK_stress],
            p->field[ROCK_von_mises], p->field[ROCK_viability], p->field[ROCK_phase], f->list, f->share,
            p->place, f->means);
    GPU_RUN(gpu, field_front, k.n, k, f->list, f->slot, f->share, f->distance);
    /* An even number of sweeps: one per voxel of the band, the others for diagonals. */
    for (int sweep = 0; sweep < FIELD_BAND; sweep++) {
        GPU_RUN(gpu, field_distance, k.n, k, f->list, f->slot, f->distance, f->other);
        GPU_RUN(gpu, field_distance, k.n, k, f->list, f->slot, f->other, f->distance);
    }
    if (k.walls)
        GPU_RUN(gpu, field_cut, k.n, k, f->list, f->distance, f->share, f->means);
}

/* Computes the share, with smoothed heaps. */
static void share_heaps(struct gpu *gpu, struct field *f, struct particles *p, struct field_params k)
{
    struct gpu_buffer *loose = f->other, *base = f->means;
    GPU_RUN(gpu, field_loose, k.n, k, f->list, p->held.words, p->start, p->fill, p->field[ROCK_phase], loose);
    GPU_RUN(gpu, field_heap_begin, k.n, k, f->list, f->slot, loose, f->distance, base);
    for (int sweep = 0; sweep < HEAP_SWEEPS / 2; sweep++) {
        GPU_RUN(gpu, field_heap_slide, k.n, k, f->list, f->slot, f->distance, base, f->share);
        GPU_RUN(gpu, field_heap_slide, k.n, k, f->list, f->slot, f->share, base, f->distance);
    }
    GPU_RUN(gpu, field_heap_fill, k.n, k, f->list, f->slot, loose, f->distance, f->share);
    GPU_RUN(gpu, field_share_heap, k.n, k, f->list, f->slot, f->share, f->other);
    struct gpu_buffer *swap = f->share;
    f->share = f->other;
    f->other = swap;
}

status field_build(struct gpu *gpu, struct gpu_work *work, struct field *f, struct particles *p,
                   double repose_deg)
{
    status st = OK;
    particles_fill(gpu, p);
    const struct field_params rock = extent_params(f, p->voxels, FIELD_MARGIN);
    GPU_RUN(gpu, field_reach, rock.n, rock, p->held.words, p->fill, f->place, f->list);
    if (f->whole)
        gpu_fill(gpu, f->list, EXTENT_ALL);
    else if (f->cut.keeps != CUT_NONE)
        TRY(expose_cut(gpu, f));
    TRY(choose(gpu, work, f));
    struct field_params k = params_of(f, p);
    k.repose = (float)tan(repose_deg * 3.14159265358979323846 / 180);
    if (k.n && repose_deg > 0 && !p->moving)
        share_heaps(gpu, f, p, k);
    else if (k.n)
        GPU_RUN(gpu, field_share, k.n, k, f->list, p->held.words, p->fill, f->share);
    finish(gpu, f, p);
done:
    return st;
}

status field_build_share(struct gpu *gpu, struct field *f, struct particles *p,
                         const struct field_share *known)
{
    status st = OK;
    const size_t n = known->n_bricks;
    if (n)
        TRY(gpu_upload(gpu, f->list, 0, known->number, n));
    TRY(field_keep(gpu, f, n));
    TRY(gpu_upload(gpu, f->slot, 0, known->slot, all_bricks(f)));
    if (n)
        TRY(gpu_upload(gpu, f->share, 0, known->share, n * BRICK_SAMPLES));
    finish(gpu, f, p);
    TRY(gpu_wait(gpu));
done:
    return st;
}

void field_skin(struct gpu *gpu, struct field *f, const struct particles *p, enum value_id which)
{
    const struct field_params k = params_of(f, p);
    if (k.n)
        GPU_RUN(gpu, field_skin, k.n, k, p->held.words, p->start, p->field[ROCK_N],
                p->field[value_field[which]], f->list, f->share, f->other);
}

void field_around(struct gpu *gpu, struct field *f, const struct particles *p, enum value_id which,
                  int component)
{
    struct field_params k = params_of(f, p);
    k.component = (uint)component;
    if (k.n)
        GPU_RUN(gpu, field_vector, k.n, k, p->held.words, p->start, p->field[value_field[which]], f->list,
                f->share, f->other);
}

void field_one_mean(struct gpu *gpu, struct field *f, int component)
{
    const struct field_params k = {.n = (uint)(f->n_bricks * BRICK_SAMPLES), .component = (uint)component};
    if (k.n)
        GPU_RUN(gpu, field_component, k.n, k, f->means, f->other);
}
