#include "blocks/blocks.h"

uint64_t blocks_bytes(size_t n)
{
    return (uint64_t)n * 12;
}

/* For so many held voxels: what is in the buffers is lost where they are too small. */
static status keep(struct gpu *gpu, struct blocks *b, size_t n)
{
    status st = OK;
    if (b->solid && gpu_buffer_count(b->solid) >= n)
        return OK;
    blocks_destroy(gpu, b);
    TRY(gpu_buffer_create(gpu, "solid voxels", n, 4, &b->solid));
    TRY(gpu_buffer_create(gpu, "block pointers", n, 4, &b->pointer));
    TRY(gpu_buffer_create(gpu, "block pointers (other)", n, 4, &b->other));
done:
    return st;
}

status blocks_create(struct gpu *gpu, size_t n, struct blocks *b)
{
    status st = OK;
    *b = (struct blocks){0};
    TRY(keep(gpu, b, n));
done:
    if (st != OK)
        blocks_destroy(gpu, b);
    return st;
}

void blocks_destroy(struct gpu *gpu, struct blocks *b)
{
    gpu_buffer_destroy(gpu, &b->solid);
    gpu_buffer_destroy(gpu, &b->pointer);
    gpu_buffer_destroy(gpu, &b->other);
}

status blocks_join(struct gpu *gpu, struct gpu_work *work, struct blocks *b, const struct held_voxels *h)
{
    status st = OK;
    const size_t n = h->n;
    const struct voxel_params k = {
        .n = (uint)n, .nx = (uint)h->voxels[0], .ny = (uint)h->voxels[1], .nz = (uint)h->voxels[2]};
    struct gpu_buffer *counts = gpu_work_words(work);
    uint32_t changed = n > 0;
    if (n == 0)
        return OK;
    GPU_RUN(gpu, blocks_below, n, k, h->words, h->list, b->solid, b->pointer);
    while (changed) {
        TRY(gpu_double_pointers(gpu, work, b->pointer, b->other, n));
        gpu_fill(gpu, counts, 0);
        gpu_copy(gpu, b->other, b->pointer, n);
        GPU_RUN(gpu, blocks_join, n, k, h->words, h->list, b->solid, b->other, b->pointer, counts);
        TRY(gpu_download(gpu, counts, COUNT_CHANGED, &changed, 1));
    }
done:
    return st;
}

/* What stands on the ground, of the particles as they are. Waits. */
static status find(struct gpu *gpu, struct gpu_work *work, struct blocks *b, struct particles *p)
{
    status st = OK;
    const size_t n = p->held.n;
    const struct voxel_params k = particles_params(p, n);
    TRY(keep(gpu, b, n));
    particles_fill(gpu, p);
    GPU_RUN(gpu, blocks_solid, n, k, p->held.words, p->held.list, p->fill, b->solid);
    if (b->rubble) {
        GPU_RUN(gpu, blocks_rest, n, k, p->held.words, p->start, p->held.list, b->solid, p->field[ROCK_phase],
                b->other);
        gpu_copy(gpu, b->solid, b->other, n);
    }
    TRY(blocks_join(gpu, work, b, &p->held));
done:
    return st;
}

status blocks_loose(struct gpu *gpu, struct gpu_work *work, struct blocks *b, struct particles *p,
                    size_t least, uint32_t *n_crumbs, size_t *n)
{
    status st = OK;
    struct gpu_buffer *counts = gpu_work_words(work);
    TRY(find(gpu, work, b, p));
    struct crumble_params k = {
        .n = (uint)p->n, .nx = (uint)p->voxels[0], .ny = (uint)p->voxels[1], .nz = (uint)p->voxels[2]};
    k.h = (float)p->h;
    k.least = (uint)least;
    GPU_RUN(gpu, blocks_loose, p->n, k, p->field[ROCK_P], b->solid, b->pointer, p->start,
            p->field[ROCK_phase], p->field[ROCK_viability], p->flags, p->held.words);
    gpu_fill(gpu, b->other, 0);
    GPU_RUN(gpu, blocks_size, p->n, k, p->field[ROCK_P], b->solid, b->pointer, p->flags, p->held.words,
            p->place, b->other);
    gpu_fill(gpu, counts, 0);
    GPU_RUN(gpu, blocks_crumble, p->n, k, p->place, b->other, p->flags, p->field[ROCK_viability], counts);
    TRY(gpu_download(gpu, counts, COUNT_FALLEN, n_crumbs, 1));
    TRY(gpu_compact(gpu, work, p->flags, p->place, p->surface, p->n, n));
    p->n_surface = 0;
done:
    return st;
}

status blocks_fall(struct gpu *gpu, struct gpu_work *work, struct blocks *b, struct particles *p,
                   uint32_t *n_fallen)
{
    status st = OK;
    struct voxel_params k = particles_params(p, p->n);
    struct gpu_buffer *counts = gpu_work_words(work);
    TRY(find(gpu, work, b, p));
    GPU_RUN(gpu, blocks_fall, p->n, k, p->field[ROCK_P], b->solid, b->pointer, p->start, p->field[ROCK_phase],
            p->field[ROCK_viability], counts, p->held.words);
    TRY(gpu_download(gpu, counts, COUNT_FALLEN, n_fallen, 1));
done:
    return st;
}
