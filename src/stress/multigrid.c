#include "stress/multigrid.h"

/* Smoother steps on the finest, the middle and the coarsest levels; cells across at which coarsening ends. */
enum { FINEST_STEPS = 1, STEPS = 2, COARSEST_STEPS = 8, COARSEST_CELLS = 4 };

/* Cells of the next coarser level (with margin); false if `cells` is coarse enough. */
static bool coarsen(const int cells[3], int coarse[3])
{
    int most = 0;
    for (int a = 0; a < 3; a++) {
        most = cells[a] - 2 > most ? cells[a] - 2 : most;
        coarse[a] = (cells[a] - 1) / 2 + 2;
    }
    return most > COARSEST_CELLS;
}

/* Bytes per item besides the lattice's: r, z and other. */
enum { VALUE_BYTES = 3 * 16 };

uint64_t multigrid_bytes(const int cells[3], const struct rock_size *rock)
{
    struct rock_size coarser = *rock;
    int now[3] = {cells[0], cells[1], cells[2]}, coarse[3];
    uint64_t bytes = 0;
    while (coarsen(now, coarse)) {
        coarser = (struct rock_size){coarser.inside / 8, coarser.bare / 4, coarser.ends / 4};
        bytes += lattice_bytes(coarse, &coarser, VALUE_BYTES);
        for (int a = 0; a < 3; a++)
            now[a] = coarse[a];
    }
    return bytes;
}

status multigrid_create(struct gpu *gpu, const int cells[3], struct multigrid *m)
{
    status st = OK;
    int coarse[3];
    *m = (struct multigrid){.n = 1, .level[0].lattice.cells = {cells[0], cells[1], cells[2]}};
    while (m->n < STRESS_LEVELS && coarsen(m->level[m->n - 1].lattice.cells, coarse)) {
        m->n++;
        TRY(lattice_create(gpu, coarse, &m->level[m->n - 1].lattice));
    }
done:
    return st;
}

void multigrid_destroy(struct gpu *gpu, struct multigrid *m)
{
    for (int n = 1; n < m->n; n++) {
        struct stress_level *l = &m->level[n];
        struct gpu_buffer **all[] = {&l->r, &l->z, &l->other};
        for (size_t i = 0; i < sizeof all / sizeof *all; i++)
            gpu_buffer_destroy(gpu, all[i]);
        lattice_destroy(gpu, &l->lattice);
    }
    m->n = 0;
}

/* Parameters for n invocations of a kernel between level l and the coarser l[1]. */
static struct coarse_params between(const struct stress_level *l, size_t n)
{
    const int *cells = l->lattice.cells, *above = l[1].lattice.cells;
    return (struct coarse_params){(uint)n,        (uint)cells[0], (uint)cells[1], (uint)cells[2],
                                  (uint)above[0], (uint)above[1], (uint)above[2], l->params.walls};
}

/* Lays out a level: it keeps the cells that have filled children. */
static status choose(struct gpu *gpu, struct gpu_work *work, const struct stress_level *below,
                     struct stress_level *l, struct gpu_buffer *marks)
{
    status st = OK;
    const struct coarse_params k = between(below, lattice_items(&below->lattice));
    gpu_fill(gpu, marks, 0);
    GPU_RUN(gpu, stress_mark_coarse, k.n, k, below->lattice.run, below->lattice.fill, marks);
    TRY(lattice_choose(gpu, work, &l->lattice, marks));
    lattice_table(gpu, &l->lattice);
    TRY(lattice_buffer(gpu, &l->lattice, "coarse residual", 16, &l->r));
    TRY(lattice_buffer(gpu, &l->lattice, "coarse correction", 16, &l->z));
    TRY(lattice_buffer(gpu, &l->lattice, "coarse defect", 16, &l->other));
done:
    return st;
}

static status assemble_level(struct gpu *gpu, struct gpu_work *work, const struct stress_level *below,
                             struct stress_level *l, struct gpu_buffer *marks)
{
    status st = OK;
    struct stress_lattice *at = &l->lattice;
    TRY(choose(gpu, work, below, l, marks));
    const struct coarse_params k = between(below, lattice_items(at));
    GPU_RUN(gpu, stress_coarsen, k.n, k, at->run, below->lattice.table, below->lattice.fill, at->fill);
    TRY(lattice_activate(gpu, work, at));
    l->params = below->params;
    l->params.cx = (uint)at->cells[0];
    l->params.cy = (uint)at->cells[1];
    l->params.cz = (uint)at->cells[2];
    l->params.dx *= 2;
    l->params.n = (uint)at->n_active;
    GPU_RUN(gpu, stress_diagonal, l->params.n, l->params, at->list, at->run, at->table, at->fill, l->r);
    gpu_fill(gpu, l->z, 0); /* nodes that do not move are read as zero */
    gpu_fill(gpu, l->other, 0);
done:
    return st;
}

/* The largest coordinate of a filled cell, counted from the domain's corner. */
static status farthest(struct gpu *gpu, struct gpu_work *work, const struct stress_level *l, uint32_t *cells)
{
    struct stress_params k = l->params;
    k.n = (uint)lattice_items(&l->lattice);
    gpu_fill(gpu, gpu_work_words(work), 0);
    GPU_RUN(gpu, stress_farthest, k.n, k, l->lattice.run, l->lattice.fill, gpu_work_words(work));
    return gpu_download(gpu, gpu_work_words(work), 0, cells, 1);
}

status multigrid_assemble(struct gpu *gpu, struct gpu_work *work, struct multigrid *m,
                          struct gpu_buffer *marks)
{
    status st = OK;
    uint32_t across;
    gpu_fill(gpu, m->level[0].z, 0);
    gpu_fill(gpu, m->level[0].other, 0);
    TRY(farthest(gpu, work, &m->level[0], &across));
    /* As in coarsen(), but only as far as the rock reaches, so that the size of the domain around it does not matter. */
    for (m->n_used = 1; m->n_used < m->n && across > COARSEST_CELLS; m->n_used++) {
        TRY(assemble_level(gpu, work, &m->level[m->n_used - 1], &m->level[m->n_used], marks));
        across = (across + 1) / 2;
    }
done:
    return st;
}

/* Weights of smoother step k (from 0) of `steps`: the fourth-kind Chebyshev recurrence of Lottes 2022. */
static struct smooth_params weights(const struct stress_level *l, int steps, int k)
{
    const struct stress_params *p = &l->params;
    /* Largest eigenvalue of the element matrix, that of uniform expansion, over its diagonal. */
    const double most =
        (1.5 * (double)p->lambda + (double)p->mu) / (((double)p->lambda + 4 * (double)p->mu) / 9);
    /* A single step converges faster with 1.6 than with the polynomial's 4/3. */
    return (struct smooth_params){
        .n = p->n,
        .cx = p->cx,
        .cy = p->cy,
        .cz = p->cz,
        .lambda = p->lambda,
        .mu = p->mu,
        .dx = p->dx,
        .walls = p->walls,
        .keep = k ? (float)((2.0 * k - 1) / (2.0 * k + 3)) : 0,
        .gain = (float)((steps == 1 ? 1.6 : (8.0 * k + 4) / (2.0 * k + 3)) / most),
    };
}

/* Smoothes the correction z; `fresh`: z counts as 0 and is not read. */
static void smooth(struct gpu *gpu, struct stress_level *l, int steps, bool fresh)
{
    const struct stress_lattice *at = &l->lattice;
    for (int k = 0; k < steps; k++) {
        struct smooth_params p = weights(l, steps, k);
        if (k == 0 && fresh) {
            GPU_RUN(gpu, stress_start, p.n, p, at->list, l->r, l->z);
            continue;
        }
        p.second = k == 1 && fresh;
        GPU_RUN(gpu, stress_smooth, p.n, p, at->list, at->run, at->table, l->z, at->fill, l->r, l->other,
                l->other);
        struct gpu_buffer *z = l->other;
        l->other = l->z;
        l->z = z;
    }
}

/* Attributes what is recorded next to a level's timer. */
static void name_stage(struct gpu *gpu, int n)
{
    static const char *const names[] = {"stress", "stress level 1", "stress level 2", "stress level 3 on"};
    gpu_stage(gpu, names[n < 3 ? n : 3]);
}

static void cycle(struct gpu *gpu, struct multigrid *m, int n, bool fresh)
{
    struct stress_level *l = &m->level[n], *up = l + 1;
    const struct stress_lattice *at = &l->lattice, *above = &up->lattice;
    const int steps = n == 0 ? FINEST_STEPS : STEPS;
    name_stage(gpu, n);
    if (n == m->n_used - 1) {
        smooth(gpu, l, COARSEST_STEPS, fresh);
        return;
    }
    smooth(gpu, l, steps, fresh);
    GPU_RUN(gpu, stress_defect, at->n_active, l->params, at->list, at->run, at->table, l->z, at->fill, l->r,
            l->other);
    struct coarse_params k = between(l, above->n_active);
    GPU_RUN(gpu, stress_restrict, k.n, k, above->list, above->run, at->table, l->other, up->r, up->r);
    cycle(gpu, m, n + 1, true);
    if (n + 1 < m->n_used - 1)
        cycle(gpu, m, n + 1, false);
    name_stage(gpu, n);
    k.n = (uint)at->n_active;
    GPU_RUN(gpu, stress_prolong, k.n, k, at->list, at->run, above->table, up->z, l->z, l->z);
    smooth(gpu, l, steps, false);
}

void multigrid_cycle(struct gpu *gpu, struct multigrid *m)
{
    cycle(gpu, m, 0, true);
}
