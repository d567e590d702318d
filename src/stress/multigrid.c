#include "stress/multigrid.h"

/* Steps of the smoother; cells across at which coarsening ends. */
enum { FINEST_STEPS = 1, STEPS = 2, COARSEST_STEPS = 8, COARSEST_CELLS = 4 };

static size_t nodes_of(const int cells[3])
{
    return (size_t)(cells[0] + 1) * (size_t)(cells[1] + 1) * (size_t)(cells[2] + 1);
}

static size_t cells_of(const int cells[3])
{
    return (size_t)cells[0] * (size_t)cells[1] * (size_t)cells[2];
}

/* The next coarser level's cells; false where it ends. */
static bool coarsen(const int cells[3], int coarse[3])
{
    int most = 0;
    for (int a = 0; a < 3; a++) {
        most = cells[a] - 2 > most ? cells[a] - 2 : most;
        coarse[a] = (cells[a] - 1) / 2 + 2;
    }
    return most > COARSEST_CELLS;
}

static uint64_t level_bytes(const int cells[3])
{
    return nodes_of(cells) * (3 * 16 + 4) + cells_of(cells) * 4;
}

uint64_t multigrid_bytes(const int cells[3])
{
    int now[3] = {cells[0], cells[1], cells[2]}, coarse[3];
    uint64_t bytes = 0;
    while (coarsen(now, coarse)) {
        bytes += level_bytes(coarse);
        for (int a = 0; a < 3; a++)
            now[a] = coarse[a];
    }
    return bytes;
}

status multigrid_create(struct gpu *gpu, const int cells[3], struct multigrid *m)
{
    status st = OK;
    *m = (struct multigrid){.n = 1, .level[0].cells = {cells[0], cells[1], cells[2]}};
    while (m->n < STRESS_LEVELS && coarsen(m->level[m->n - 1].cells, m->level[m->n].cells)) {
        struct stress_level *l = &m->level[m->n++];
        const size_t nodes = nodes_of(l->cells);
        TRY(gpu_buffer_create(gpu, "coarse fill", cells_of(l->cells), 4, &l->fill));
        TRY(gpu_buffer_create(gpu, "coarse nodes", nodes, 4, &l->list));
        TRY(gpu_buffer_create(gpu, "coarse residual", nodes, 16, &l->r));
        TRY(gpu_buffer_create(gpu, "coarse correction", nodes, 16, &l->z));
        TRY(gpu_buffer_create(gpu, "coarse defect", nodes, 16, &l->other));
    }
done:
    return st;
}

void multigrid_destroy(struct gpu *gpu, struct multigrid *m)
{
    for (int n = 1; n < m->n; n++) {
        struct stress_level *l = &m->level[n];
        struct gpu_buffer **all[] = {&l->fill, &l->list, &l->r, &l->z, &l->other};
        for (size_t i = 0; i < sizeof all / sizeof *all; i++)
            gpu_buffer_destroy(gpu, all[i]);
    }
    m->n = 0;
}

/* `n` invocations between a level and the coarser one. */
static struct coarse_params between(const struct stress_level *l, size_t n)
{
    const struct stress_level *up = l + 1;
    return (struct coarse_params){(uint)n,           (uint)l->cells[0],  (uint)l->cells[1],
                                  (uint)l->cells[2], (uint)up->cells[0], (uint)up->cells[1],
                                  (uint)up->cells[2]};
}

static status assemble_level(struct gpu *gpu, struct gpu_work *work, const struct stress_level *below,
                             struct stress_level *l, struct gpu_buffer *flags, struct gpu_buffer *place)
{
    status st = OK;
    const size_t nodes = nodes_of(l->cells);
    const struct coarse_params k =
        between(below, (size_t)(l->cells[0] - 2) * (size_t)(l->cells[1] - 2) * (size_t)(l->cells[2] - 2));
    GPU_RUN(gpu, stress_coarsen, k.n, k, below->fill, l->fill);
    l->params = below->params;
    l->params.cx = (uint)l->cells[0];
    l->params.cy = (uint)l->cells[1];
    l->params.cz = (uint)l->cells[2];
    l->params.dx *= 2;
    l->params.n = (uint)nodes;
    GPU_RUN(gpu, stress_active, nodes, l->params, l->fill, flags);
    TRY(gpu_compact(gpu, work, flags, place, l->list, nodes, &l->n_active));
    l->params.n = (uint)l->n_active;
    GPU_RUN(gpu, stress_diagonal, l->n_active, l->params, l->list, l->fill, l->r);
    gpu_fill(gpu, l->z, 0); /* what does not move counts as zero */
    gpu_fill(gpu, l->other, 0);
done:
    return st;
}

status multigrid_assemble(struct gpu *gpu, struct gpu_work *work, struct multigrid *m,
                          struct gpu_buffer *flags, struct gpu_buffer *place)
{
    status st = OK;
    gpu_fill(gpu, m->level[0].z, 0);
    gpu_fill(gpu, m->level[0].other, 0);
    for (int n = 1; n < m->n; n++)
        TRY(assemble_level(gpu, work, &m->level[n - 1], &m->level[n], flags, place));
done:
    return st;
}

/* The weights of step k (from 0) of `steps`. */
static struct smooth_params weights(const struct stress_level *l, int steps, int k)
{
    const struct stress_params *p = &l->params;
    /* The largest eigenvalue of an element matrix, that of even expansion, by its diagonal. */
    const double most =
        (1.5 * (double)p->lambda + (double)p->mu) / (((double)p->lambda + 4 * (double)p->mu) / 9);
    /* One step alone is better damped less than the polynomial's 4/3. */
    return (struct smooth_params){
        .n = p->n,
        .cx = p->cx,
        .cy = p->cy,
        .cz = p->cz,
        .lambda = p->lambda,
        .mu = p->mu,
        .dx = p->dx,
        .keep = k ? (float)((2.0 * k - 1) / (2.0 * k + 3)) : 0,
        .gain = (float)((steps == 1 ? 1.6 : (8.0 * k + 4) / (2.0 * k + 3)) / most),
    };
}

/* From the correction z, or from none at all: `fresh`. */
static void smooth(struct gpu *gpu, struct stress_level *l, int steps, bool fresh)
{
    for (int k = 0; k < steps; k++) {
        struct smooth_params p = weights(l, steps, k);
        if (k == 0 && fresh) {
            GPU_RUN(gpu, stress_start, p.n, p, l->list, l->r, l->z);
            continue;
        }
        p.second = k == 1 && fresh;
        GPU_RUN(gpu, stress_smooth, p.n, p, l->list, l->z, l->fill, l->r, l->other, l->other);
        struct gpu_buffer *z = l->other;
        l->other = l->z;
        l->z = z;
    }
}

/* What follows is a level's, for the timers. */
static void tell(struct gpu *gpu, int n)
{
    static const char *const names[] = {"stress", "stress level 1", "stress level 2", "stress level 3 on"};
    gpu_stage(gpu, names[n < 3 ? n : 3]);
}

static void cycle(struct gpu *gpu, struct multigrid *m, int n, bool fresh)
{
    struct stress_level *l = &m->level[n], *up = l + 1;
    const int steps = n == 0 ? FINEST_STEPS : STEPS;
    tell(gpu, n);
    if (n == m->n - 1) {
        smooth(gpu, l, COARSEST_STEPS, fresh);
        return;
    }
    smooth(gpu, l, steps, fresh);
    GPU_RUN(gpu, stress_defect, l->n_active, l->params, l->list, l->z, l->fill, l->r, l->other);
    struct coarse_params k = between(l, up->n_active);
    GPU_RUN(gpu, stress_restrict, k.n, k, up->list, l->other, up->r, up->r);
    cycle(gpu, m, n + 1, true);
    if (n + 1 < m->n - 1)
        cycle(gpu, m, n + 1, false);
    tell(gpu, n);
    k.n = (uint)l->n_active;
    GPU_RUN(gpu, stress_prolong, k.n, k, l->list, up->z, l->z, l->z);
    smooth(gpu, l, steps, false);
}

void multigrid_cycle(struct gpu *gpu, struct multigrid *m)
{
    cycle(gpu, m, 0, true);
}
