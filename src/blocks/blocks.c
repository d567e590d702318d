#include "blocks/blocks.h"

uint64_t blocks_bytes(size_t n)
{
    return (uint64_t)n * 12;
}

/* Grows the buffers to n nodes; contents are lost if they were too small. */
static status reserve(struct gpu *gpu, struct blocks *b, size_t n)
{
    status st = OK;
    if (b->solid && gpu_buffer_count(b->solid) >= n)
        return OK;
    gpu_buffer_destroy(gpu, &b->solid);
    gpu_buffer_destroy(gpu, &b->pointer);
    gpu_buffer_destroy(gpu, &b->other);
    TRY(gpu_buffer_create(gpu, "solid voxels", n, 4, &b->solid));
    TRY(gpu_buffer_create(gpu, "block pointers", n, 4, &b->pointer));
    TRY(gpu_buffer_create(gpu, "block pointers (other)", n, 4, &b->other));
done:
    return st;
}

status blocks_create(struct gpu *gpu, size_t n, struct gpu_buffer *parted, struct blocks *b)
{
    status st = OK;
    *b = (struct blocks){.parted = parted};
    TRY(reserve(gpu, b, n));
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
    gpu_buffer_destroy(gpu, &b->first);
}

/* Labels blocks: every node points to its block's root. `runs`: NULL if there are none; `list`: words of bits that have some. */
static status join(struct gpu *gpu, struct gpu_work *work, struct blocks *b, const struct held_voxels *h,
                   struct runs_params *runs, size_t n_runs, struct gpu_buffer *list)
{
    status st = OK;
    const size_t n = h->n + n_runs;
    const struct voxel_params k = {
        .n = (uint)h->n, .nx = (uint)h->voxels[0], .ny = (uint)h->voxels[1], .nz = (uint)h->voxels[2]};
    struct join_params beside = {.n = k.n, .nx = k.nx, .ny = k.ny, .nz = k.nz, .parted = b->parted != NULL};
    struct gpu_buffer *parted = b->parted ? b->parted : h->words;
    struct gpu_rounds r = {.what = "blocks: voxels still join", .most = (uint32_t)n};
    if (h->n == 0)
        return OK;
    if (runs) {
        const struct count_params all = {(uint)n};
        GPU_RUN(gpu, gpu_iota, n, all, b->pointer);
    }
    GPU_RUN(gpu, blocks_below, h->n, k, h->words, h->list, b->solid, b->pointer);
    while (gpu_round(gpu, work, &r)) {
        TRY(gpu_double_pointers(gpu, work, b->pointer, b->other, n));
        beside.flag = r.flag;
        gpu_copy(gpu, b->other, b->pointer, n);
        GPU_RUN(gpu, blocks_join, h->n, beside, h->words, h->list, b->solid, b->other, b->pointer, r.flags,
                parted);
        if (runs) {
            runs->flag = r.flag;
            GPU_RUN(gpu, blocks_join_runs, runs->n, *runs, h->words, b->first, b->solid, b->other, b->pointer,
                    r.flags, list);
        }
    }
    TRY(r.st);
done:
    return st;
}

status blocks_join(struct gpu *gpu, struct gpu_work *work, struct blocks *b, const struct held_voxels *h)
{
    return join(gpu, work, b, h, NULL, 0, NULL);
}

/* Numbers the runs of deep voxels (*n) and lists in p->place the words of bits that have some. */
static status count_runs(struct gpu *gpu, struct gpu_work *work, struct blocks *b, const struct particles *p,
                         struct runs_params *k, size_t *n)
{
    status st = OK;
    const size_t words = held_words(p->voxels);
    const struct count_params all = {(uint)words};
    size_t n_list;
    uint32_t found;
    *k = (struct runs_params){.n = (uint)words + 1,
                              .nx = (uint)p->voxels[0],
                              .ny = (uint)p->voxels[1],
                              .nz = (uint)p->voxels[2],
                              .slots = (uint)p->held.n,
                              .words = (uint)words};
    if (!b->first)
        TRY(gpu_buffer_create(gpu, "runs of deep voxels", words + 1, 4, &b->first));
    GPU_RUN(gpu, blocks_deep_words, words, all, p->held.words, p->flags);
    TRY(gpu_compact(gpu, work, p->flags, b->first, p->place, words, &n_list));
    GPU_RUN(gpu, blocks_count_runs, k->n, *k, p->held.words, b->first);
    gpu_scan(gpu, work, b->first, words + 1);
    TRY(gpu_download(gpu, b->first, words, &found, 1));
    k->n = (uint)n_list;
    *n = found;
done:
    return st;
}

/* Fills `solid` from the surface field, and with rubble also across small gaps. */
static void find_solid(struct gpu *gpu, struct blocks *b, struct particles *p)
{
    const size_t n = p->held.n;
    const struct voxel_params k = particles_params(p, n);
    particles_fill(gpu, p);
    GPU_RUN(gpu, blocks_solid, n, k, p->held.words, p->held.list, p->fill, b->solid);
    if (b->rubble) {
        GPU_RUN(gpu, blocks_rest, n, k, p->held.words, p->start, p->held.list, b->solid, p->field[ROCK_phase],
                b->other);
        gpu_copy(gpu, b->solid, b->other, n);
    }
}

status blocks_find(struct gpu *gpu, struct gpu_work *work, struct blocks *b, struct particles *p,
                   size_t *n_cut)
{
    status st = OK;
    struct runs_params runs;
    size_t n_runs = 0;
    uint32_t cut;
    struct gpu_buffer *counts = gpu_work_words(work);
    *n_cut = 0;
    if (p->n_deep)
        TRY(count_runs(gpu, work, b, p, &runs, &n_runs));
    TRY(reserve(gpu, b, p->held.n + n_runs));
    find_solid(gpu, b, p);
    TRY(join(gpu, work, b, &p->held, p->n_deep ? &runs : NULL, n_runs, p->place));
    if (p->n_deep == 0)
        return OK;
    gpu_fill(gpu, counts, 0);
    gpu_fill(gpu, p->flags, 0);
    GPU_RUN(gpu, blocks_cut_runs, runs.n, runs, p->held.words, b->first, b->pointer, p->flags, counts,
            p->place);
    TRY(gpu_download(gpu, counts, COUNT_BORN, &cut, 1));
    gpu_fill(gpu, counts, 0);
    *n_cut = cut;
done:
    return st;
}

status blocks_loose(struct gpu *gpu, struct gpu_work *work, struct blocks *b, struct particles *p,
                    size_t least, uint32_t *n_fragments, size_t *n)
{
    status st = OK;
    struct gpu_buffer *counts = gpu_work_words(work);
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
    TRY(gpu_download(gpu, counts, COUNT_FALLEN, n_fragments, 1));
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
    gpu_fill(gpu, counts, 0);
    GPU_RUN(gpu, blocks_fall, p->n, k, p->field[ROCK_P], b->solid, b->pointer, p->start, p->field[ROCK_phase],
            p->field[ROCK_viability], counts, p->held.words);
    TRY(gpu_download(gpu, counts, COUNT_FALLEN, n_fallen, 1));
done:
    return st;
}
