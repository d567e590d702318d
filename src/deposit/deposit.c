#include "deposit/deposit.h"

#include <math.h>

#include "base/random.h"

enum { ROUNDS = 24 };

static size_t bit_words(const int voxels[3])
{
    return (size_t)voxels[0] * (size_t)voxels[1] * (((size_t)voxels[2] + 31) / 32);
}

/* Maximum number of cells, for any shift of the grid. */
static size_t cells_max(const int voxels[3])
{
    return ((size_t)voxels[0] / 2 + 1) * ((size_t)voxels[1] / 2 + 1) * ((size_t)voxels[2] / 2 + 1);
}

bool deposit_wanted(const struct job *job)
{
    return curve_max(&job->deposition.viability) > 0;
}

double deposit_bulk(const struct job *job)
{
    return (1 - job->deposition.fines) * job->deposition.bulking;
}

uint64_t deposit_bytes(const int voxels[3])
{
    return 4 * ((uint64_t)bit_words(voxels) + 6 * (uint64_t)cells_max(voxels));
}

status deposit_create(struct gpu *gpu, const int voxels[3], struct deposit *d)
{
    status st = OK;
    size_t cells = cells_max(voxels);
    *d = (struct deposit){0};
    TRY(gpu_buffer_create(gpu, "deposits: columns", bit_words(voxels), 4, &d->bits));
    TRY(gpu_buffer_create(gpu, "deposits: room", cells, 4, &d->room));
    TRY(gpu_buffer_create(gpu, "deposits: ground", cells, 4, &d->ground));
    TRY(gpu_buffer_create(gpu, "deposits: pointers", cells, 4, &d->pointer));
    TRY(gpu_buffer_create(gpu, "deposits: pointers (other)", cells, 4, &d->other));
    TRY(gpu_buffer_create(gpu, "deposits: fragments by cell", cells + 2, 4, &d->start));
    TRY(gpu_buffer_create(gpu, "deposits: scratch", cells + 1, 4, &d->taken));
done:
    if (st != OK)
        deposit_destroy(gpu, d);
    return st;
}

static void destroy_fragments(struct gpu *gpu, struct deposit *d)
{
    struct gpu_buffer **all[] = {&d->id, &d->cell, &d->place, &d->key, &d->order, &d->unordered};
    for (size_t i = 0; i < sizeof all / sizeof *all; i++)
        gpu_buffer_destroy(gpu, all[i]);
    d->n_fragments_max = 0;
}

void deposit_destroy(struct gpu *gpu, struct deposit *d)
{
    destroy_fragments(gpu, d);
    gpu_buffer_destroy(gpu, &d->bits);
    gpu_buffer_destroy(gpu, &d->room);
    gpu_buffer_destroy(gpu, &d->ground);
    gpu_buffer_destroy(gpu, &d->pointer);
    gpu_buffer_destroy(gpu, &d->other);
    gpu_buffer_destroy(gpu, &d->start);
    gpu_buffer_destroy(gpu, &d->taken);
    *d = (struct deposit){0};
}

/* Grows the buffers to n fragments and a half more. */
static status reserve(struct gpu *gpu, struct deposit *d, size_t n)
{
    status st = OK;
    if (n <= d->n_fragments_max)
        return OK;
    destroy_fragments(gpu, d);
    size_t most = n + n / 2 + 1024;
    TRY(gpu_buffer_create(gpu, "fragments: ids", most, 4, &d->id));
    TRY(gpu_buffer_create(gpu, "fragments: cells", most, 4, &d->cell));
    TRY(gpu_buffer_create(gpu, "fragments: places", most, 4, &d->place));
    TRY(gpu_buffer_create(gpu, "fragments: keys", most, 4, &d->key));
    TRY(gpu_buffer_create(gpu, "fragments: order", most, 4, &d->order));
    TRY(gpu_buffer_create(gpu, "fragments: scratch", most, 4, &d->unordered));
    d->n_fragments_max = most;
done:
    return st;
}

static struct deposit_params params(const struct job *job, int frame, int step,
                                    const struct deposit_routing *routing, const struct particles *p)
{
    double viability = curve_at(&job->deposition.viability, frame);
    return (struct deposit_params){
        .nx = (uint)p->voxels[0],
        .ny = (uint)p->voxels[1],
        .nz = (uint)p->voxels[2],
        .h = (float)p->h,
        .words = ((uint)p->voxels[2] + 31) / 32,
        .cx = (uint)routing->cells[0],
        .cy = (uint)routing->cells[1],
        .cz = (uint)routing->cells[2],
        .sx = routing->shift[0],
        .sy = routing->shift[1],
        .sz = routing->shift[2],
        .repose = (float)tan(job->deposition.repose_deg * 3.14159265358979323846 / 180),
        .seed = random_hash((uint32_t)job->seed, (uint32_t)frame, (uint32_t)step, RANDOM_DEPOSIT),
        .quicker = (float)(viability > 0 ? 1 / viability : 1),
        .walls = p->walls,
        .dust = random_hash((uint32_t)job->seed, 0, 1, RANDOM_DEPOSIT),
        .bulk = (float)deposit_bulk(job),
        .through = (float)exp(-p->h / job->vegetation.burial_m),
    };
}

/* Marks fragments, and computes the columns' bits without them and the list of ground cells. */
static status begin(struct gpu *gpu, struct gpu_work *work, struct deposit *d,
                    const struct deposit_routing *routing, struct deposit_params k, struct particles *p)
{
    status st = OK;
    struct count_params list = {(uint)d->n_cells};
    k.n = (uint)p->n;
    GPU_RUN(gpu, deposit_mark, k.n, k, p->field[ROCK_viability], p->field[ROCK_P], p->field[ROCK_phase],
            p->start, p->flags, p->held.words);
    k.n = k.nx * k.ny * k.words;
    GPU_RUN(gpu, deposit_bits, k.n, k, p->start, p->flags, d->bits, p->held.words);
    GPU_RUN(gpu, deposit_list, list.n, list, routing->tag, d->pointer);
    TRY(gpu_compact(gpu, work, d->pointer, d->other, d->ground, d->n_cells, &d->n_ground));
    gpu_fill(gpu, d->room, 0);
done:
    return st;
}

/* One round: room of the cells, paths of the fragments, and landing. */
static status advance(struct gpu *gpu, struct gpu_work *work, struct deposit *d,
                      const struct deposit_routing *routing, struct deposit_params k, struct particles *p,
                      size_t n_fragments, uint32_t *n_waiting)
{
    status st = OK;
    struct count_params cells = {(uint)d->n_cells};
    struct gpu_buffer *counts = gpu_work_words(work);
    struct gpu_sort sort = {.keys = d->key,
                            .ids = d->id,
                            .start = d->start,
                            .order = d->order,
                            .taken = d->taken,
                            .unordered = d->unordered,
                            .n = n_fragments,
                            .n_keys = d->n_cells + 1,
                            .n_ordered = d->n_cells};
    k.n = (uint)d->n_ground;
    GPU_RUN(gpu, deposit_room, k.n, k, d->ground, d->bits, routing->tag, d->room);
    if (k.round == 0) {
        GPU_RUN(gpu, deposit_point, cells.n, cells, routing->receiver, d->room, d->pointer);
        TRY(gpu_double_pointers(gpu, work, d->pointer, d->other, d->n_cells));
    }
    k.n = (uint)n_fragments;
    if (k.last)
        GPU_RUN(gpu, deposit_stay, k.n, k, p->surface, p->field[ROCK_P], p->field[ROCK_viability], d->place,
                d->bits);
    GPU_RUN(gpu, deposit_move, k.n, k, d->id, routing->tag, routing->receiver, d->pointer, d->bits, d->cell,
            d->place, d->key, p->surface, p->field[ROCK_viability], d->room);
    gpu_sort(gpu, work, &sort);
    GPU_RUN(gpu, deposit_settle, k.n, k, d->order, d->start, d->key, d->id, routing->tag, d->room, d->bits,
            d->place);
    gpu_fill(gpu, counts, 0);
    GPU_RUN(gpu, deposit_rise, k.n, k, d->place, d->bits, counts);
    TRY(gpu_download(gpu, counts, COUNT_WAITING, n_waiting, 1));
done:
    return st;
}

status deposit_land(struct gpu *gpu, struct gpu_work *work, struct deposit *d, const struct job *job,
                    int frame, int step, const struct deposit_routing *routing, struct particles *p,
                    bool last, struct deposit_counts *out)
{
    status st = OK;
    struct deposit_params k = params(job, frame, step, routing, p);
    struct gpu_buffer *counts = gpu_work_words(work);
    uint32_t gone[COUNT_WAITING + 1], waiting;
    size_t n_fragments;
    *out = (struct deposit_counts){0};
    d->n_cells = (size_t)k.cx * k.cy * k.cz;
    TRY(begin(gpu, work, d, routing, k, p));
    gpu_fill(gpu, counts, 0);
    k.n = (uint)d->n_ground;
    GPU_RUN(gpu, deposit_slide, k.n, k, d->ground, d->bits, p->start, p->field[ROCK_phase], p->flags, counts,
            p->held.words);
    TRY(gpu_download(gpu, counts, 0, gone, COUNT_WAITING + 1));
    out->slid = gone[COUNT_SLID];
    TRY(gpu_compact(gpu, work, p->flags, p->place, p->surface, p->n, &n_fragments));
    out->fragments = waiting = (uint32_t)n_fragments;
    if (n_fragments == 0)
        return OK;
    TRY(reserve(gpu, d, n_fragments));
    k.n = (uint)n_fragments;
    GPU_RUN(gpu, deposit_begin, k.n, k, p->surface, p->field[ROCK_P], p->field[ROCK_id], routing->tag,
            p->start, p->flags, d->id, d->cell, d->place, d->bits, p->held.words, p->field[ROCK_phase]);
    for (k.round = 0; k.round < ROUNDS && waiting > 0; k.round++) {
        k.last = k.round + 1 < ROUNDS ? 0 : last ? 2 : 1;
        TRY(advance(gpu, work, d, routing, k, p, n_fragments, &waiting));
    }
    out->rounds = k.round;
    gpu_fill(gpu, counts, 0);
    k.n = (uint)n_fragments;
    GPU_RUN(gpu, deposit_apply, k.n, k, p->surface, d->id, d->place, p->field[ROCK_P],
            p->field[ROCK_viability], p->field[ROCK_phase], p->field[ROCK_rate_factor],
            p->field[ROCK_vegetation], p->field[ROCK_stress], p->start, p->held.words, p->flags, counts);
    TRY(gpu_download(gpu, counts, 0, gone, COUNT_WAITING + 1));
    out->landed = gone[COUNT_LANDED];
    out->left = gone[COUNT_GONE];
    out->waiting = gone[COUNT_WAITING];
done:
    return st;
}

status deposit_count(struct gpu *gpu, struct gpu_work *work, const struct particles *p, uint32_t *n_deposits)
{
    status st = OK;
    struct scan_params k = {(uint)((p->n + SCAN_RUN - 1) / SCAN_RUN), (uint)p->n};
    struct gpu_buffer *counts = gpu_work_words(work);
    gpu_fill(gpu, counts, 0);
    GPU_RUN(gpu, deposit_count, k.n, k, p->field[ROCK_phase], counts);
    TRY(gpu_download(gpu, counts, COUNT_LANDED, n_deposits, 1));
done:
    return st;
}
