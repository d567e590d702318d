#include "particles/particles.h"

#include <string.h>

uint64_t particles_bytes(size_t n, const int voxels[3])
{
    uint64_t item = 4 + 3 * 4; /* surface; start, fill and taken, per voxel */
    for (int f = 0; f < ROCK_FIELDS; f++)
        item += f == ROCK_v || rock_field_is_optional(f) ? 0 : rock_field_size((enum rock_field)f);
    return (uint64_t)n * item + 2 * 4 * (uint64_t)particles_scratch(voxels, n) + held_bytes(voxels, n);
}

struct voxel_params particles_params(const struct particles *p, size_t n)
{
    return (struct voxel_params){.n = (uint)n,
                                 .nx = (uint)p->voxels[0],
                                 .ny = (uint)p->voxels[1],
                                 .nz = (uint)p->voxels[2],
                                 .h = (float)p->h,
                                 .walls = p->walls};
}

/* The buffers with one word per held voxel. */
static status keep_voxels(struct gpu *gpu, struct particles *p)
{
    status st = OK;
    if (p->start && gpu_buffer_count(p->fill) >= p->held.n)
        return OK;
    const size_t n = p->held.n > p->n_max ? p->held.n + p->held.n / 8 : p->n_max;
    gpu_buffer_destroy(gpu, &p->start);
    gpu_buffer_destroy(gpu, &p->fill);
    gpu_buffer_destroy(gpu, &p->taken);
    TRY(gpu_buffer_create(gpu, "voxel start", n + 2, 4, &p->start));
    TRY(gpu_buffer_create(gpu, "voxel fill", n, 4, &p->fill));
    TRY(gpu_buffer_create(gpu, "voxel scratch", n + 1, 4, &p->taken));
done:
    return st;
}

/* Gathers a field in the order of p->surface into the spare buffer, and swaps the two. */
static void reorder(struct gpu *gpu, struct particles *p, struct gpu_buffer **field,
                    struct gpu_buffer **spare, size_t n)
{
    struct gpu_buffer *old = *field;
    gpu_gather(gpu, p->surface, old, *spare, n);
    *field = *spare;
    *spare = old;
}

enum stay { STAYS_LEFT, STAYS_WAITING, STAYS_ALL };

/* Which particles stay: not 0 (1 or the viability). May be p->place. */
static struct gpu_buffer *staying(struct gpu *gpu, struct particles *p, enum stay stay)
{
    const struct count_params k = {(uint)p->n};
    const float one = 1;
    uint32_t bits;
    if (stay == STAYS_LEFT)
        return p->field[ROCK_viability];
    memcpy(&bits, &one, sizeof bits);
    if (stay == STAYS_ALL)
        gpu_fill(gpu, p->place, bits);
    else
        GPU_RUN(gpu, particles_remain, k.n, k, p->field[ROCK_viability], p->place);
    return p->place;
}

/* particles_index() for fields up to `keep`, and stress. `vector` and `word` are spare buffers, which are 0 afterwards. */
static status index_fields(struct gpu *gpu, struct gpu_work *work, struct particles *p, int keep,
                           enum stay stay, struct gpu_buffer **vector, struct gpu_buffer **word)
{
    status st = OK;
    const struct voxel_params k = particles_params(p, p->n);
    uint32_t alive;
    struct gpu_buffer *left = staying(gpu, p, stay);
    held_vacate(gpu, &p->held);
    GPU_RUN(gpu, particles_occupy, p->n, k, p->field[ROCK_P], left, p->held.words);
    TRY(held_find(gpu, work, &p->held, p->around));
    TRY(keep_voxels(gpu, p));
    const struct gpu_sort sort = {.keys = p->flags,
                                  .ids = p->field[ROCK_id],
                                  .start = p->start,
                                  .order = p->surface, /* recomputed after this */
                                  .taken = p->taken,
                                  .unordered = p->place,
                                  .n = p->n,
                                  .n_keys = p->held.n + 1,
                                  .n_ordered = p->held.n};
    GPU_RUN(gpu, particles_key, p->n, k, p->field[ROCK_P], left, p->held.words, p->flags);
    gpu_sort(gpu, work, &sort);
    TRY(gpu_download(gpu, p->start, p->held.n, &alive, 1));
    for (int f = 0; f < ROCK_FIELDS; f++)
        if ((rock_field_table[f].keep <= keep || f == ROCK_stress) && p->field[f])
            reorder(gpu, p, &p->field[f], rock_field_size((enum rock_field)f) == 16 ? vector : word, alive);
    gpu_fill(gpu, *vector, 0);
    gpu_fill(gpu, *word, 0);
    p->n = alive;
    p->n_surface = 0;
done:
    return st;
}

/* Sorts the STATE fields; two DERIVED ones, which are stale, serve as spare buffers. */
static status index_state(struct gpu *gpu, struct gpu_work *work, struct particles *p, enum stay stay)
{
    return index_fields(gpu, work, p, STATE, stay, &p->field[ROCK_N], &p->field[ROCK_von_mises]);
}

/* Sorts all fields. */
static status index_derived(struct gpu *gpu, struct gpu_work *work, struct particles *p)
{
    status st = OK;
    struct gpu_buffer *vector = NULL, *word = NULL;
    TRY(gpu_buffer_create(gpu, "spare vectors", p->n_max, 16, &vector));
    TRY(gpu_buffer_create(gpu, "spare words", p->n_max, 4, &word));
    TRY(index_fields(gpu, work, p, DERIVED, STAYS_LEFT, &vector, &word));
    TRY(gpu_wait(gpu));
done:
    gpu_buffer_destroy(gpu, &vector);
    gpu_buffer_destroy(gpu, &word);
    return st;
}

static bool moves(const struct rock *rock)
{
    for (size_t i = 0; rock->v && i < 4 * rock->n; i++)
        if (rock->v[i] != 0)
            return true;
    return false;
}

status particles_create(struct gpu *gpu, struct gpu_work *work, const struct rock *rock, int keep,
                        const int voxels[3], double h, struct particles *p)
{
    status st = OK;
    *p = (struct particles){
        .n = rock->n, .n_max = rock->n, .voxels = {voxels[0], voxels[1], voxels[2]}, .h = h};
    for (int f = 0; f < ROCK_FIELDS; f++) {
        if ((f == ROCK_v && !(keep == DERIVED && moves(rock))) ||
            (rock_field_is_optional(f) && !rock->field[f]))
            continue;
        TRY(gpu_buffer_create(gpu, rock_field_table[f].name, p->n_max, rock_field_size((enum rock_field)f),
                              &p->field[f]));
        if (rock_field_table[f].keep <= keep && rock->field[f])
            TRY(gpu_upload(gpu, p->field[f], 0, rock->field[f], rock->n));
    }
    TRY(held_create(gpu, voxels, p->n_max, &p->held));
    TRY(gpu_buffer_create(gpu, "surface list", p->n_max, 4, &p->surface));
    const size_t scratch = particles_scratch(voxels, p->n_max);
    TRY(gpu_buffer_create(gpu, "particle flags", scratch, 4, &p->flags));
    TRY(gpu_buffer_create(gpu, "particle places", scratch, 4, &p->place));
    TRY(keep == STATE ? index_state(gpu, work, p, STAYS_LEFT) : index_derived(gpu, work, p));
done:
    if (st != OK)
        particles_destroy(gpu, p);
    return st;
}

void particles_destroy(struct gpu *gpu, struct particles *p)
{
    for (int f = 0; f < ROCK_FIELDS; f++)
        gpu_buffer_destroy(gpu, &p->field[f]);
    held_destroy(gpu, &p->held);
    gpu_buffer_destroy(gpu, &p->start);
    gpu_buffer_destroy(gpu, &p->fill);
    gpu_buffer_destroy(gpu, &p->taken);
    gpu_buffer_destroy(gpu, &p->surface);
    gpu_buffer_destroy(gpu, &p->flags);
    gpu_buffer_destroy(gpu, &p->place);
    *p = (struct particles){0};
}

status particles_index(struct gpu *gpu, struct gpu_work *work, struct particles *p)
{
    return index_state(gpu, work, p, STAYS_LEFT);
}

status particles_index_waiting(struct gpu *gpu, struct gpu_work *work, struct particles *p)
{
    return index_state(gpu, work, p, STAYS_WAITING);
}

status particles_index_all(struct gpu *gpu, struct gpu_work *work, struct particles *p)
{
    return index_state(gpu, work, p, STAYS_ALL);
}

status particles_hold_around(struct gpu *gpu, struct gpu_work *work, struct particles *p)
{
    if (p->around)
        return OK;
    p->around = true;
    return index_state(gpu, work, p, STAYS_LEFT);
}

static status add_field(struct gpu *gpu, struct particles *p, enum rock_field f)
{
    if (p->field[f])
        return OK;
    return gpu_buffer_create(gpu, rock_field_table[f].name, p->n_max, rock_field_size(f), &p->field[f]);
}

status particles_allow_motion(struct gpu *gpu, struct particles *p)
{
    return add_field(gpu, p, ROCK_v);
}

status particles_keep(struct gpu *gpu, struct particles *p, enum rock_field field)
{
    return add_field(gpu, p, field);
}

void particles_fill(struct gpu *gpu, struct particles *p)
{
    struct voxel_params k = particles_params(p, p->held.n);
    if (p->moving)
        GPU_RUN(gpu, particles_spread, k.n, k, p->held.words, p->start, p->held.list, p->field[ROCK_P],
                p->field[ROCK_viability], p->fill);
    else
        GPU_RUN(gpu, particles_fill, k.n, k, p->start, p->field[ROCK_viability], p->fill);
}

status particles_surface(struct gpu *gpu, struct gpu_work *work, struct particles *p)
{
    status st = OK;
    struct voxel_params k = particles_params(p, p->n);
    GPU_RUN(gpu, particles_exposed, p->n, k, p->field[ROCK_P], p->held.words, p->flags);
    TRY(gpu_compact(gpu, work, p->flags, p->place, p->surface, p->n, &p->n_surface));
    gpu_fill(gpu, p->field[ROCK_N], 0);
    k.n = (uint)p->n_surface;
    GPU_RUN(gpu, particles_normal, p->n_surface, k, p->surface, p->field[ROCK_P], p->held.words, p->start,
            p->field[ROCK_N]);
done:
    return st;
}

status particles_download(struct gpu *gpu, const struct particles *p, int keep, struct rock *out)
{
    status st = OK;
    TRY(rock_alloc(out, p->n, keep));
    for (int f = 0; f < ROCK_FIELDS; f++)
        if (rock_field_is_optional(f) && rock_field_table[f].keep <= keep && p->field[f])
            TRY(rock_keep(out, (enum rock_field)f));
    for (int f = 0; f < ROCK_FIELDS; f++)
        if (out->field[f] && p->field[f])
            TRY(gpu_download(gpu, p->field[f], 0, out->field[f], p->n));
done:
    if (st != OK)
        rock_free(out);
    return st;
}
