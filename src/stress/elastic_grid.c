/* Memory of the stress grid, and its update to a new shape of the rock. */
#include "stress/elastic.h"

/* Cells with the margin. */
static void cells_of(const int voxels[3], int cells[3])
{
    for (int a = 0; a < 3; a++)
        cells[a] = voxels[a] / 2 + 2;
}

/* Bytes per item besides the lattice's: u, p, q, r, the two stress buffers, and the weight. */
enum { VALUE_BYTES = 6 * 16 + 4 };

uint64_t elastic_bytes(const int voxels[3], uint64_t n, uint64_t bare, uint64_t ends)
{
    const struct rock_size rock = {n / 8, bare / 4, ends / 4};
    int cells[3];
    cells_of(voxels, cells);
    return (lattice_runs(cells) + 1) * 4 + lattice_bytes(cells, &rock, VALUE_BYTES) +
           multigrid_bytes(cells, &rock);
}

size_t elastic_work_items(const int voxels[3])
{
    int cells[3];
    cells_of(voxels, cells);
    return lattice_items_most(cells);
}

/* Creates the buffers of values for the lattice's current capacity, but not that of the displacement, which is still read. */
static status create_values(struct gpu *gpu, struct elastic *e)
{
    status st = OK;
    TRY(lattice_buffer(gpu, &e->lattice, "search direction", 16, &e->p));
    TRY(lattice_buffer(gpu, &e->lattice, "search image", 16, &e->q));
    TRY(lattice_buffer(gpu, &e->lattice, "residual", 16, &e->r));
    TRY(lattice_buffer(gpu, &e->lattice, "normal stress", 16, &e->normal_stress));
    TRY(lattice_buffer(gpu, &e->lattice, "shear stress", 16, &e->shear_stress));
    TRY(lattice_buffer(gpu, &e->lattice, "cell weight", 4, &e->weight));
done:
    return st;
}

status elastic_create(struct gpu *gpu, const int voxels[3], double h, const struct elastic_options *options,
                      struct elastic *e)
{
    status st = OK;
    int cells[3];
    cells_of(voxels, cells);
    *e = (struct elastic){.dx = 2 * h, .options = *options};
    TRY(lattice_create(gpu, cells, &e->lattice));
    e->lattice.walls = options->walls;
    TRY(gpu_buffer_create(gpu, "marks of runs", e->lattice.n_table + 1, 4, &e->marks));
    TRY(gpu_buffer_create(gpu, "solver scalars", CG_ENERGY + CG_CHECK, 4, &e->scalars));
    TRY(create_values(gpu, e));
    TRY(lattice_buffer(gpu, &e->lattice, "displacement", 16, &e->u));
    TRY(multigrid_create(gpu, cells, &e->levels));
done:
    if (st != OK)
        elastic_destroy(gpu, e);
    return st;
}

void elastic_destroy(struct gpu *gpu, struct elastic *e)
{
    struct gpu_buffer **all[] = {
        &e->u, &e->p, &e->q, &e->r, &e->scalars, &e->marks, &e->normal_stress, &e->shear_stress, &e->weight};
    for (size_t i = 0; i < sizeof all / sizeof *all; i++)
        gpu_buffer_destroy(gpu, all[i]);
    lattice_destroy(gpu, &e->lattice);
    multigrid_destroy(gpu, &e->levels);
}

/* ---- the shape */

/* Copies the displacement to its slots in the new layout, in p. The table is still the old one. */
static status carry(struct gpu *gpu, struct elastic *e)
{
    status st = OK;
    const struct count_params k = {(uint)lattice_items(&e->lattice)};
    GPU_RUN(gpu, stress_carry, k.n, k, e->lattice.run, e->lattice.table, e->u, e->p);
    TRY(lattice_buffer(gpu, &e->lattice, "displacement", 16, &e->u));
done:
    return st;
}

/* Sets u from values in q, in the order of the list; 0 elsewhere. */
static void scatter_to_u(struct gpu *gpu, struct elastic *e)
{
    const struct count_params k = {(uint)e->lattice.n_active};
    gpu_fill(gpu, e->u, 0);
    GPU_RUN(gpu, stress_place, k.n, k, e->lattice.list, e->q, e->u);
}

status elastic_assemble(struct gpu *gpu, struct gpu_work *work, struct elastic *e, const struct particles *p)
{
    status st = OK;
    const struct voxel_params v = particles_params(p, p->n);
    struct stress_lattice *l = &e->lattice;
    gpu_fill(gpu, e->marks, 0);
    GPU_RUN(gpu, stress_mark, v.n, v, p->field[ROCK_P], e->marks);
    if (p->n_deep) {
        const struct voxel_params words = particles_params(p, held_words(p->voxels));
        GPU_RUN(gpu, stress_mark_deep, words.n, words, p->held.words, e->marks);
    }
    TRY(lattice_choose(gpu, work, l, e->marks));
    TRY(create_values(gpu, e));
    TRY(carry(gpu, e));
    lattice_table(gpu, l);
    struct stress_params k = lattice_params(l, lattice_items(l));
    k.loose = (float)e->options.loose; /* material and load are not read */
    k.jointed = e->options.stiff != NULL;
    struct gpu_buffer *stiff = e->options.stiff ? e->options.stiff : e->marks; /* any: it is not looked at */
    GPU_RUN(gpu, stress_fill, k.n, k, l->run, p->held.words, p->start, p->field[ROCK_viability],
            p->field[ROCK_phase], l->fill, e->weight, stiff);
    TRY(lattice_activate(gpu, work, l));
    gpu_gather(gpu, l->list, e->p, e->q, l->n_active);
    scatter_to_u(gpu, e);
done:
    return st;
}

status elastic_clear(struct gpu *gpu, struct elastic *e)
{
    status st = OK;
    const struct elastic was = *e;
    const int *cells = was.lattice.cells,
              voxels[3] = {2 * (cells[0] - 2), 2 * (cells[1] - 2), 2 * (cells[2] - 2)};
    if (was.lattice.n == 0)
        return OK;
    elastic_destroy(gpu, e);
    TRY(elastic_create(gpu, voxels, was.dx / 2, &was.options, e));
    e->iterations = was.iterations;
    e->error = was.error;
done:
    return st;
}

status elastic_download(struct gpu *gpu, struct elastic *e, void *out)
{
    gpu_gather(gpu, e->lattice.list, e->u, e->q, e->lattice.n_active);
    return gpu_download(gpu, e->q, 0, out, e->lattice.n_active);
}

status elastic_upload(struct gpu *gpu, struct elastic *e, const void *u)
{
    status st = OK;
    TRY(gpu_upload(gpu, e->q, 0, u, e->lattice.n_active));
    scatter_to_u(gpu, e);
done:
    return st;
}
