#include "particles/deep.h"

static struct count_params words_of(const struct particles *p)
{
    return (struct count_params){(uint)held_words(p->voxels)};
}

status particles_set_deep(struct gpu *gpu, struct gpu_work *work, struct particles *p, const uint32_t *bits,
                          size_t n)
{
    status st = OK;
    const struct count_params k = words_of(p);
    TRY(gpu_upload(gpu, p->flags, 0, bits, k.n));
    GPU_RUN(gpu, particles_deepen, k.n, k, p->flags, p->held.words);
    p->n_deep = n;
    TRY(particles_index(gpu, work, p));
done:
    return st;
}

void particles_mark_near(struct gpu *gpu, struct particles *p, uint32_t reach)
{
    struct near_params k = {.n = words_of(p).n,
                            .nx = (uint)p->voxels[0],
                            .ny = (uint)p->voxels[1],
                            .nz = (uint)p->voxels[2],
                            .reach = reach};
    GPU_RUN(gpu, particles_near, k.n, k, p->held.words, p->place);
    k.axis = 1;
    GPU_RUN(gpu, particles_near, k.n, k, p->place, p->flags);
    k.axis = 2;
    GPU_RUN(gpu, particles_near, k.n, k, p->flags, p->place);
}

/* Writes the bits of deep voxels to p->flags: those marked in p->place, or `all`. Waits for the device. */
static status find_due(struct gpu *gpu, struct gpu_work *work, struct particles *p, bool all, size_t *n)
{
    status st = OK;
    const struct born_params k = {words_of(p).n, all};
    struct gpu_buffer *counts = gpu_work_words(work);
    uint32_t found;
    gpu_fill(gpu, counts, 0);
    GPU_RUN(gpu, particles_born, k.n, k, p->place, p->held.words, p->flags, counts);
    TRY(gpu_download(gpu, counts, COUNT_BORN, &found, 1));
    *n = found;
done:
    return st;
}

static status find_near(struct gpu *gpu, struct gpu_work *work, struct particles *p, size_t *n)
{
    status st = OK;
    particles_mark_near(gpu, p, NEAR_REACH + 1);
    TRY(find_due(gpu, work, p, false, n));
    if (*n == 0)
        return OK;
    particles_mark_near(gpu, p, NEAR_REACH + 1 + NEAR_AHEAD);
    TRY(find_due(gpu, work, p, false, n));
done:
    return st;
}

status particles_due(struct gpu *gpu, struct gpu_work *work, struct particles *p, enum particles_due what,
                     uint32_t *bits, size_t *n)
{
    status st = OK;
    const struct count_params k = words_of(p);
    if (what == DUE_NEAR)
        TRY(find_near(gpu, work, p, n));
    else if (what == DUE_ALL)
        TRY(find_due(gpu, work, p, true, n));
    if (*n == 0)
        return OK;
    GPU_RUN(gpu, particles_undeep, k.n, k, p->flags, p->held.words);
    TRY(gpu_download(gpu, p->flags, 0, bits, k.n));
done:
    return st;
}

status particles_deep_bits(struct gpu *gpu, struct gpu_work *work, struct particles *p, uint32_t *bits)
{
    status st = OK;
    size_t n;
    TRY(find_due(gpu, work, p, true, &n));
    TRY(gpu_download(gpu, p->flags, 0, bits, words_of(p).n));
done:
    return st;
}

/* Grows a buffer of n_max items to n; the first `keep` items are preserved. */
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
                     rock_field_table[f].keep == STATE || f == ROCK_stress ? p->n : 0, &p->field[f]));
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
        if ((rock_field_table[f].keep == STATE || f == ROCK_stress) && rock->field[f])
            TRY(gpu_upload(gpu, p->field[f], p->n, rock->field[f], rock->n));
    p->n += rock->n;
    p->n_deep -= rock->n;
    TRY(particles_index_all(gpu, work, p));
done:
    return st;
}
