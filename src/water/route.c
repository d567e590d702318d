/* Flow routing: columns as bits, spans, pits, basins joined over their lowest passes (Boruvka), and reversed receivers from pass
 * to pit. */
#include <assert.h>

#include "base/random.h"
#include "water/internal.h"

uint32_t water_random(const struct water_routing *how, int shift[3])
{
    uint32_t random = random_hash(how->seed, (uint32_t)how->frame, (uint32_t)how->step, RANDOM_WATER);
    uint32_t bits = random_hash(random, 0, 0, RANDOM_SHIFT);
    for (int a = 0; a < 3; a++)
        shift[a] = how->unshifted ? 0 : (int)(bits >> (8 * a) & 1);
    return random;
}

struct water_params water_params(const struct water *w, size_t n)
{
    return (struct water_params){.n = (uint)n,
                                 .vx = (uint)w->voxels[0],
                                 .vy = (uint)w->voxels[1],
                                 .vz = (uint)w->voxels[2],
                                 .size = (uint)w->size,
                                 .sx = (uint)w->shift[0],
                                 .sy = (uint)w->shift[1],
                                 .sz = (uint)w->shift[2],
                                 .cx = (uint)w->cells[0],
                                 .cy = (uint)w->cells[1],
                                 .cz = (uint)w->cells[2],
                                 .words = (uint)w->words,
                                 .nodes = (uint)w->n_nodes,
                                 .basins = (uint)w->n_basins,
                                 .leak = w->leak,
                                 .random = w->random,
                                 .rain = w->rain_units,
                                 .per_row = 1.0f / (float)w->cells[0],
                                 .per_slab = 1.0f / (float)w->columns,
                                 .walls = w->walls};
}

/* Finds the spans of every column and their altitudes. */
static status find_nodes(struct gpu *gpu, struct gpu_work *work, struct water *w, const struct particles *p)
{
    status st = OK;
    size_t n_words = w->columns * w->words;
    struct gpu_buffer *rows = w->rows ? w->rows : p->held.words; /* the voxels' bits are such rows already */
    struct water_params k = water_params(w, n_words);
    uint32_t n_nodes;
    gpu_fill(gpu, w->first, 0);
    k.n = (uint)(((size_t)w->cells[0] + 31) / 32 * (size_t)w->cells[1] * (size_t)w->cells[2]);
    if (w->rows)
        GPU_RUN(gpu, water_rows, k.n, k, p->held.words, w->rows);
    k.n = (uint)n_words;
    GPU_RUN(gpu, water_columns, n_words, k, rows, w->occupied, w->floors, w->first);
    gpu_scan(gpu, work, w->first, n_words + 1);
    TRY(gpu_download(gpu, w->first, n_words, &n_nodes, 1));
    w->n_nodes = n_nodes;
    TRY(water_reserve(gpu, w, w->n_nodes));
    GPU_RUN(gpu, water_nodes, n_words, k, w->floors, w->first, w->node[WATER_CELL]);
    k = water_params(w, w->n_nodes);
    GPU_RUN(gpu, water_altitude, w->n_nodes, k, w->node[WATER_CELL], p->held.words, p->start,
            p->field[ROCK_viability], w->node[WATER_Z]);
done:
    return st;
}

/* Initial receivers, passes, and the basin of every span. *n_border: number of spans with passes to other basins, listed in the
 * last scratch array. */
static status find_basins(struct gpu *gpu, struct gpu_work *work, struct water *w, size_t *n_border)
{
    status st = OK;
    struct gpu_buffer **scratch = &w->node[WATER_SCRATCH];
    struct gpu_buffer *root = scratch[0], *flags = scratch[1], *place = scratch[2], *list = scratch[3];
    struct water_params k = water_params(w, w->n_nodes + 1);
    GPU_RUN(gpu, water_receive, k.n, k, w->occupied, w->floors, w->first, w->node[WATER_CELL],
            w->node[WATER_Z], w->pass, w->node[WATER_INITIAL], root);
    TRY(gpu_double_pointers(gpu, work, root, place, w->n_nodes + 1));
    k.n = (uint)w->n_nodes;
    GPU_RUN(gpu, water_pit, k.n, k, root, flags);
    TRY(gpu_compact(gpu, work, flags, place, list, w->n_nodes, &w->n_basins));
    k = water_params(w, w->n_nodes);
    GPU_RUN(gpu, water_basin, k.n, k, root, place, w->pass, w->node[WATER_BASIN], flags);
    TRY(gpu_compact(gpu, work, flags, place, list, w->n_nodes, n_border));
done:
    return st;
}

/* Boruvka: every component of basins drains over its lowest pass, in rounds until none without a path out has a pass left. */
static status join_basins(struct gpu *gpu, struct gpu_work *work, struct water *w, size_t n_border)
{
    status st = OK;
    struct gpu_buffer **node = w->node, *border = node[WATER_SCRATCH + 3];
    struct count_params n = {(uint)w->n_basins + 1};
    struct water_params k = water_params(w, n_border), all = water_params(w, w->n_basins + 1);
    /* Each round at least halves the number of components that have a pass but no path out. */
    struct gpu_rounds r = {.what = "water: basins still join", .most = 64};
    GPU_RUN(gpu, gpu_iota, n.n, n, node[WATER_COMPONENT]);
    gpu_fill(gpu, node[WATER_LOWEST], UINT32_MAX);
    gpu_fill(gpu, node[WATER_PICK], UINT32_MAX);
    while (n_border > 0 && gpu_round(gpu, work, &r)) {
        all.flag = r.flag;
        GPU_RUN(gpu, water_lowest, n_border, k, border, w->pass, node[WATER_BASIN], node[WATER_COMPONENT],
                node[WATER_Z], node[WATER_LOWEST]);
        GPU_RUN(gpu, water_pick, n_border, k, border, w->pass, node[WATER_BASIN], node[WATER_COMPONENT],
                node[WATER_Z], node[WATER_LOWEST], node[WATER_PICK]);
        GPU_RUN(gpu, water_join, all.n, all, node[WATER_COMPONENT], node[WATER_PICK], w->pass,
                node[WATER_BASIN], node[WATER_NEXT], node[WATER_FROM], node[WATER_TO], r.flags);
        TRY(gpu_double_pointers(gpu, work, node[WATER_NEXT], node[WATER_SCRATCH], w->n_basins + 1));
        GPU_RUN(gpu, water_merge, all.n, all, node[WATER_NEXT], node[WATER_COMPONENT], node[WATER_LOWEST],
                node[WATER_PICK]);
    }
    TRY(r.st);
done:
    return st;
}

status water_route(struct gpu *gpu, struct gpu_work *work, struct water *w, const struct water_routing *how,
                   struct particles *p)
{
    status st = OK;
    size_t n_border = 0;
    struct gpu_buffer **node = w->node;
    w->random = water_random(how, w->shift);
    w->leak = how->leak;
    for (int a = 0; a < 3; a++) {
        w->shift[a] = w->size > 1 ? w->shift[a] : 0;
        w->cells[a] = w->voxels[a] / w->size + w->shift[a];
    }
    w->columns = (size_t)w->cells[0] * (size_t)w->cells[1];
    w->words = ((size_t)w->cells[2] + 31) / 32;
    w->n_basins = 0;
    for (w->rain_units = 1U << 20; w->rain_units > 1 && w->columns >= (1U << 31) / w->rain_units;)
        w->rain_units /= 2;
    TRY(find_nodes(gpu, work, w, p));
    TRY(find_basins(gpu, work, w, &n_border));
    TRY(join_basins(gpu, work, w, n_border));
    gpu_copy(gpu, w->node[WATER_FINAL], w->node[WATER_INITIAL], w->n_nodes + 1);
    struct water_params k = water_params(w, w->n_basins);
    GPU_RUN(gpu, water_carve, k.n, k, node[WATER_COMPONENT], node[WATER_FROM], node[WATER_TO],
            node[WATER_INITIAL], node[WATER_FINAL]);
    k.n = (uint)(w->columns * (size_t)w->cells[2]);
    if (how->cells) {
        TRY(water_reserve_cells(gpu, w));
        GPU_RUN(gpu, water_cells, k.n, k, w->occupied, w->floors, w->first, node[WATER_CELL], node[WATER_Z],
                node[WATER_FINAL], node[WATER_BASIN], node[WATER_COMPONENT], w->tag, w->z, w->receiver);
    }
done:
    return st;
}
