#include "blocks/blocks.h"

uint64_t blocks_bytes(const int voxels[3])
{
    return (uint64_t)voxel_count(voxels) * 12;
}

status blocks_create(struct gpu *gpu, const int voxels[3], struct blocks *b)
{
    status st = OK;
    *b = (struct blocks){0};
    TRY(gpu_buffer_create(gpu, "solid voxels", voxel_count(voxels), 4, &b->solid));
    TRY(gpu_buffer_create(gpu, "block pointers", voxel_count(voxels), 4, &b->pointer));
    TRY(gpu_buffer_create(gpu, "block pointers (other)", voxel_count(voxels), 4, &b->other));
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

status blocks_join(struct gpu *gpu, struct gpu_work *work, struct blocks *b, const int voxels[3])
{
    status st = OK;
    size_t n = voxel_count(voxels), columns = n / (size_t)voxels[2];
    struct voxel_params k = {
        .n = (uint)columns, .nx = (uint)voxels[0], .ny = (uint)voxels[1], .nz = (uint)voxels[2]};
    struct gpu_buffer *counts = gpu_work_words(work);
    uint32_t changed = 1;
    GPU_RUN(gpu, blocks_column, columns, k, b->solid, b->pointer);
    k.n = (uint)n;
    while (changed) {
        gpu_fill(gpu, counts, 0);
        gpu_copy(gpu, b->other, b->pointer, n);
        GPU_RUN(gpu, blocks_join, n, k, b->solid, b->other, b->pointer, counts);
        TRY(gpu_download(gpu, counts, COUNT_CHANGED, &changed, 1));
        if (changed)
            TRY(gpu_double_pointers(gpu, work, b->pointer, b->other, n));
    }
done:
    return st;
}

/* What stands on the ground, of the particles as they are. Waits. */
static status find(struct gpu *gpu, struct gpu_work *work, struct blocks *b, struct particles *p)
{
    size_t n = voxel_count(p->voxels);
    struct voxel_params k = particles_params(p, n);
    particles_fill(gpu, p);
    GPU_RUN(gpu, blocks_solid, n, k, p->fill, b->solid);
    if (b->rubble) {
        GPU_RUN(gpu, blocks_rest, n, k, b->solid, p->start, p->field[ROCK_phase], b->other);
        gpu_copy(gpu, b->solid, b->other, n);
    }
    return blocks_join(gpu, work, b, p->voxels);
}

status blocks_loose(struct gpu *gpu, struct gpu_work *work, struct blocks *b, struct particles *p, size_t *n)
{
    status st = OK;
    TRY(find(gpu, work, b, p));
    struct voxel_params k = particles_params(p, p->n);
    GPU_RUN(gpu, blocks_loose, p->n, k, p->field[ROCK_P], b->solid, b->pointer, p->start,
            p->field[ROCK_phase], p->flags);
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
            p->field[ROCK_viability], counts);
    TRY(gpu_download(gpu, counts, COUNT_FALLEN, n_fallen, 1));
done:
    return st;
}
