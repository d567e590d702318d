#include "model/numbers.h"

#include <stdio.h>
#include <string.h>

/* The largest sound number. Stresses reach 1e12 Pa; nothing else comes near that. */
static const float MOST = 1e18F;
enum { NONE_BAD = -1 };

void (*numbers_plant)(struct gpu *gpu, const struct watch_list *list);

void watch_add(struct watch_list *list, const char *name, struct gpu_buffer *buffer, size_t n)
{
    if (buffer && n > 0 && list->n < WATCHED_MOST)
        list->item[list->n++] = (struct watched){name, buffer, n};
}

void watch_particles(struct watch_list *list, const struct particles *p)
{
    static const char *const names[] = {
#define FIELD(name, type, ...) _Generic((type)0, float : #name, default : NULL),
#include "particles/particles.def"
    };
    for (size_t f = 0; p && f < sizeof names / sizeof *names; f++)
        if (names[f])
            watch_add(list, names[f], p->field[f], p->n);
    list->particles = p;
    list->n_particle_items = list->n;
}

status numbers_create(struct gpu *gpu, struct gpu_buffer **found)
{
    return gpu_buffer_create(gpu, "numbers found", WATCHED_MOST, 4, found);
}

/* Looks through the arrays whose items have that many bytes, NUMBERS_ARRAYS at a time. */
static void look(struct gpu *gpu, struct gpu_buffer *found, const struct watch_list *l, size_t item_bytes)
{
    for (size_t i = 0; i < l->n;) {
        struct numbers_params k = {.most = MOST};
        struct gpu_buffer *b[NUMBERS_ARRAYS];
        size_t n = 0, threads = 0;
        for (; i < l->n && n < NUMBERS_ARRAYS; i++) {
            const struct watched *w = &l->item[i];
            if ((gpu_buffer_item(w->buffer) == 16) != (item_bytes == 16))
                continue;
            b[n] = w->buffer;
            k.n[n] = (uint)w->n;
            k.slot[n++] = (uint)i;
            threads = w->n > threads ? w->n : threads;
        }
        if (n == 0)
            return;
        for (size_t rest = n; rest < NUMBERS_ARRAYS; rest++) /* of which no item is checked */
            b[rest] = b[0];
        threads = threads < NUMBERS_THREADS ? threads : NUMBERS_THREADS;
        if (item_bytes == 16)
            GPU_RUN(gpu, numbers_vectors, threads, k, b[0], b[1], b[2], b[3], b[4], b[5], b[6], b[7], found);
        else
            GPU_RUN(gpu, numbers_scalars, threads, k, b[0], b[1], b[2], b[3], b[4], b[5], b[6], b[7], found);
    }
}

/* Writes "particle 7 at (1, 2, 3) m" or "number 7 of NAME". */
static status describe_item(struct gpu *gpu, const struct watch_list *l, size_t which, uint32_t item,
                            char out[160])
{
    status st = OK;
    const struct particles *p = l->particles;
    uint32_t id;
    float at[4];
    if (which >= l->n_particle_items) {
        snprintf(out, 160, "item %u", (unsigned)item);
        return OK;
    }
    TRY(gpu_download(gpu, p->field[ROCK_id], item, &id, 1));
    TRY(gpu_download(gpu, p->field[ROCK_P], item, at, 1));
    snprintf(out, 160, "particle %u at (%.6g, %.6g, %.6g) m", (unsigned)id, (double)at[0], (double)at[1],
             (double)at[2]);
done:
    return st;
}

static status describe(struct gpu *gpu, const struct watch_list *l, size_t which, uint32_t item, int frame)
{
    status st = OK;
    const struct watched *w = &l->item[which];
    float value[4] = {0};
    char where[160], numbers[96];
    TRY(gpu_download(gpu, w->buffer, item, value, 1));
    TRY(describe_item(gpu, l, which, item, where));
    if (gpu_buffer_item(w->buffer) == 16)
        snprintf(numbers, sizeof numbers, "(%g, %g, %g, %g)", (double)value[0], (double)value[1],
                 (double)value[2], (double)value[3]);
    else
        snprintf(numbers, sizeof numbers, "%g", (double)value[0]);
    st = fail(
        E_NUMERIC,
        "frame %d: after stage '%s', %s has %s %s, which is not finite or far too large; stopped before writing it",
        frame, l->stage, where, w->name, numbers);
done:
    return st;
}

status numbers_check(struct gpu *gpu, struct gpu_buffer *found, const struct watch_list *l, int frame)
{
    status st = OK;
    uint32_t first[WATCHED_MOST];
    if (numbers_plant)
        numbers_plant(gpu, l);
    if (l->n == 0)
        return OK;
    gpu_fill(gpu, found, (uint32_t)NONE_BAD);
    look(gpu, found, l, 4);
    look(gpu, found, l, 16);
    TRY(gpu_download(gpu, found, 0, first, l->n));
    for (size_t i = 0; i < l->n; i++)
        if (first[i] != (uint32_t)NONE_BAD)
            return describe(gpu, l, i, first[i], frame);
done:
    return st;
}
