#include "particles/deep.h"

static struct count_params words_of(const struct particles *p)
{
    return (struct count_params){(uint)held_words(p->voxels)};
}

status particles_set_deep(struct gpu *gpu, struct gpu_work *work, struct particles *p, const uint32_t *bits,
                          size_t n)
{
    status st = OK;
    if (!p->held.deep)
        TRY(gpu_buffer_create(gpu, "deep voxels", held_words(p->voxels), 4, &p->held.deep));
    TRY(gpu_upload(gpu, p->held.deep, 0, bits, held_words(p->voxels)));
    p->n_deep = n;
    TRY(particles_index(gpu, work, p));
done:
    return st;
}

void particles_near(struct gpu *gpu, struct particles *p, uint32_t reach)
{
    struct near_params k = {.n = words_of(p).n,
                            .nx = (uint)p->voxels[0],
                            .ny = (uint)p->voxels[1],
                            .nz = (uint)p->voxels[2],
                            .reach = reach};
    GPU_RUN(gpu, particles_near, k.n, k, p->held.occupied, p->place);
    k.axis = 1;
    GPU_RUN(gpu, particles_near, k.n, k, p->place, p->flags);
    k.axis = 2;
    GPU_RUN(gpu, particles_near, k.n, k, p->flags, p->place);
}

/* Into p->flags. Waits. */
static status find_due(struct gpu *gpu, struct gpu_work *work, struct particles *p, uint32_t reach, size_t *n)
{
    status st = OK;
    const struct count_params k = words_of(p);
    struct gpu_buffer *counts = gpu_work_words(work);
    uint32_t found;
    gpu_fill(gpu, counts, 0);
    particles_near(gpu, p, reach);
    GPU_RUN(gpu, particles_born, k.n, k, p->place, p->held.deep, p->flags, counts);
    TRY(gpu_download(gpu, counts, COUNT_BORN, &found, 1));
    *n = found;
done:
    return st;
}

status particles_due(struct gpu *gpu, struct gpu_work *work, struct particles *p, uint32_t *bits, size_t *n)
{
    status st = OK;
    *n = 0;
    if (p->n_deep == 0)
        return OK;
    TRY(find_due(gpu, work, p, NEAR_REACH + 1, n));
    if (*n == 0)
        return OK;
    TRY(find_due(gpu, work, p, NEAR_REACH + 1 + NEAR_AHEAD, n));
    TRY(particles_due_chosen(gpu, p, bits));
done:
    return st;
}

status particles_due_all(struct gpu *gpu, struct particles *p, uint32_t *bits)
{
    gpu_copy(gpu, p->flags, p->held.deep, words_of(p).n);
    return particles_due_chosen(gpu, p, bits);
}

status particles_due_chosen(struct gpu *gpu, struct particles *p, uint32_t *bits)
{
    const struct count_params k = words_of(p);
    GPU_RUN(gpu, particles_undeep, k.n, k, p->flags, p->held.deep);
    return gpu_download(gpu, p->flags, 0, bits, k.n);
}

/* A buffer of n_max items becomes one of n; of its contents the first `keep` items stay. */
static status grow(struct gpu *gpu, const char *name, size_t n, size_t item, size_t keep,
                   struct gpu_buffer **buffer)
{
    status st = OK;
    struct gpu_buffer *more = NULL;
    TRY(gpu_buffer_create(gpu, name, n, item, &more));
    if (keep)
        gpu_copy(gpu, more, *buffer, keep);
    TRY(gpu_wait(gpu));
    gpu_buffer_destroy(gpu, buffer);
    *buffer = more;
    more = NULL;
done:
    gpu_buffer_destroy(gpu, &more);
    return st;
}

status particles_reserve(struct gpu *gpu, struct particles *p, size_t n)
{
    status st = OK;
    if (n <= p->n_max)
        return OK;
    for (int f = 0; f < ROCK_FIELDS; f++)
        if (p->field[f])
            TRY(grow(gpu, rock_field_table[f].name, n, rock_field_size((enum rock_field)f),
                     rock_field_table[f].keep == STATE ? p->n : 0, &p->field[f]));
    TRY(grow(gpu, "surface list", n, 4, 0, &p->surface));
    const size_t scratch = particles_scratch(p->voxels, n);
    TRY(grow(gpu, "particle flags", scratch, 4, 0, &p->flags));
    TRY(grow(gpu, "particle places", scratch, 4, 0, &p->place));
    p->n_max = n;
    p->n_surface = 0;
done:
    return st;
}

status particles_add(struct gpu *gpu, struct gpu_work *work, struct particles *p, const struct rock *rock)
{
    status st = OK;
    for (int f = 0; f < ROCK_FIELDS; f++)
        if (rock_field_table[f].keep == STATE && rock->field[f])
            TRY(gpu_upload(gpu, p->field[f], p->n, rock->field[f], rock->n));
    p->n += rock->n;
    p->n_deep -= rock->n;
    TRY(particles_index_all(gpu, work, p));
done:
    return st;
}
