#include "stress/lattice.h"

/* Runs of zeros: STRESS_FIRST before the first kept run and one after the last. */
enum { EMPTY_SLOTS = STRESS_FIRST + 1 };

size_t lattice_runs(const int cells[3])
{
    return ((size_t)cells[0] / STRESS_RUN + 1) * (size_t)(cells[1] + 1) * (size_t)(cells[2] + 1);
}

static size_t items(size_t runs)
{
    return (runs + EMPTY_SLOTS) * STRESS_RUN;
}

size_t lattice_items(const struct stress_lattice *l)
{
    return items(l->capacity);
}

/* Some spare capacity, so that growing rock does not reallocate in every frame. */
static size_t capacity_for(size_t runs)
{
    return runs + runs / 32 + 1;
}

size_t lattice_items_most(const int cells[3])
{
    return items(capacity_for(lattice_runs(cells)));
}

/* Nodes inside, half of those at the surface, and where a row ends one neighbour and half a run of padding. */
static uint64_t kept_nodes(const struct rock_size *rock)
{
    return rock->inside + rock->bare / 2 + rock->ends + rock->ends * (STRESS_RUN - 1) / 2;
}

uint64_t lattice_bytes(const int cells[3], const struct rock_size *rock, uint64_t others)
{
    const uint64_t all = lattice_runs(cells), runs = kept_nodes(rock) / STRESS_RUN;
    const uint64_t kept = items(capacity_for(runs < all ? runs : all));
    return (all + 1) * 4 + kept / STRESS_RUN * 4 + kept * (4 * 4 + others);
}

status lattice_buffer(struct gpu *gpu, const struct stress_lattice *l, const char *name, size_t item,
                      struct gpu_buffer **buffer)
{
    if (*buffer && gpu_buffer_count(*buffer) == lattice_items(l))
        return OK;
    gpu_buffer_destroy(gpu, buffer);
    return gpu_buffer_create(gpu, name, lattice_items(l), item, buffer);
}

/* Adapts the capacity to n runs: grows when it is too small, shrinks when less than half is used. */
static status resize(struct gpu *gpu, struct stress_lattice *l, size_t n)
{
    status st = OK;
    if (n > l->capacity || n < l->capacity / 2 || !l->run) {
        l->capacity = capacity_for(n);
        gpu_buffer_destroy(gpu, &l->run);
        TRY(gpu_buffer_create(gpu, "runs of nodes", l->capacity + EMPTY_SLOTS, 4, &l->run));
    }
    l->n = n;
    TRY(lattice_buffer(gpu, l, "cell fill", 4, &l->fill));
    TRY(lattice_buffer(gpu, l, "active nodes", 4, &l->list));
    TRY(lattice_buffer(gpu, l, "node flags", 4, &l->flags));
    TRY(lattice_buffer(gpu, l, "node places", 4, &l->place));
    gpu_fill(gpu, l->run, STRESS_NO_RUN);
done:
    return st;
}

status lattice_create(struct gpu *gpu, const int cells[3], struct stress_lattice *l)
{
    status st = OK;
    *l = (struct stress_lattice){.cells = {cells[0], cells[1], cells[2]}, .n_table = lattice_runs(cells)};
    TRY(gpu_buffer_create(gpu, "table of runs", l->n_table, 4, &l->table));
    TRY(resize(gpu, l, 0));
    lattice_table(gpu, l);
done:
    return st;
}

void lattice_destroy(struct gpu *gpu, struct stress_lattice *l)
{
    struct gpu_buffer **all[] = {&l->table, &l->run, &l->fill, &l->list, &l->flags, &l->place};
    for (size_t i = 0; i < sizeof all / sizeof *all; i++)
        gpu_buffer_destroy(gpu, all[i]);
}

status lattice_choose(struct gpu *gpu, struct gpu_work *work, struct stress_lattice *l,
                      struct gpu_buffer *marks)
{
    status st = OK;
    uint32_t n;
    const struct count_params k = {(uint)l->n_table};
    gpu_scan(gpu, work, marks, l->n_table + 1);
    TRY(gpu_download(gpu, marks, l->n_table, &n, 1));
    TRY(resize(gpu, l, n));
    GPU_RUN(gpu, stress_choose, k.n, k, marks, l->run);
done:
    return st;
}

void lattice_table(struct gpu *gpu, struct stress_lattice *l)
{
    const struct count_params k = {(uint)l->n};
    gpu_fill(gpu, l->table, STRESS_EMPTY);
    if (k.n)
        GPU_RUN(gpu, stress_table, k.n, k, l->run, l->table);
}

struct stress_params lattice_params(const struct stress_lattice *l, size_t n)
{
    return (struct stress_params){.n = (uint)n,
                                  .cx = (uint)l->cells[0],
                                  .cy = (uint)l->cells[1],
                                  .cz = (uint)l->cells[2],
                                  .walls = l->walls};
}

status lattice_activate(struct gpu *gpu, struct gpu_work *work, struct stress_lattice *l)
{
    const struct stress_params k = lattice_params(l, lattice_items(l));
    GPU_RUN(gpu, stress_active, k.n, k, l->run, l->table, l->fill, l->flags);
    return gpu_compact(gpu, work, l->flags, l->place, l->list, k.n, &l->n_active);
}
