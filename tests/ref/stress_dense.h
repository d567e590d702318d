/* What the stress solver keeps, as arrays over its whole grid: cell (i, j, k) at elastic_ref_cell(), node at
 * elastic_ref_node() of that grid's cells. */
#ifndef HOODOO_TESTS_STRESS_DENSE_H
#define HOODOO_TESTS_STRESS_DENSE_H

#include <stdlib.h>
#include <string.h>

#include "stress/elastic.h"

static inline size_t dense_cells(const int c[3])
{
    return (size_t)c[0] * (size_t)c[1] * (size_t)c[2];
}

static inline size_t dense_nodes(const int c[3])
{
    return (size_t)(c[0] + 1) * (size_t)(c[1] + 1) * (size_t)(c[2] + 1);
}

/* Items between what is kept and what is dense, cells or `nodes`; what is not kept reads as zero, and is not written. */
static inline void dense_move(const struct stress_lattice *l, const uint32_t *table, char *kept, char *dense,
                              size_t item, bool nodes, bool to_dense)
{
    const size_t more = nodes, nx = (size_t)l->cells[0] + more, ny = (size_t)l->cells[1] + more,
                 nz = (size_t)l->cells[2] + more, across = (size_t)l->cells[0] / STRESS_RUN + 1;
    for (size_t k = 0; k < nz; k++)
        for (size_t j = 0; j < ny; j++)
            for (size_t i = 0; i < nx; i++, dense += item) {
                const size_t run = (k * (size_t)(l->cells[1] + 1) + j) * across + i / STRESS_RUN;
                char *at = kept + (table[run] + i % STRESS_RUN) * item;
                if (to_dense)
                    memcpy(dense, at, item);
                else if (table[run] != STRESS_EMPTY)
                    memcpy(at, dense, item);
            }
}

static inline status dense_transfer(struct gpu *gpu, const struct stress_lattice *l,
                                    struct gpu_buffer *buffer, void *dense, bool nodes, bool to_dense)
{
    status st = OK;
    const size_t item = gpu_buffer_item(buffer);
    char *kept = malloc(lattice_items(l) * item);
    uint32_t *table = malloc(l->n_table * sizeof *table);
    if (!kept || !table)
        st = fail(E_MEMORY, "no memory for the dense grid");
    else if ((st = gpu_download(gpu, buffer, 0, kept, lattice_items(l))) == OK &&
             (st = gpu_download(gpu, l->table, 0, table, l->n_table)) == OK) {
        dense_move(l, table, kept, dense, item, nodes, to_dense);
        if (!to_dense)
            st = gpu_upload(gpu, buffer, 0, kept, lattice_items(l));
    }
    free(kept);
    free(table);
    return st;
}

static inline status dense_download(struct gpu *gpu, const struct stress_lattice *l,
                                    struct gpu_buffer *buffer, bool nodes, void *out)
{
    return dense_transfer(gpu, l, buffer, out, nodes, true);
}

static inline status dense_upload(struct gpu *gpu, const struct stress_lattice *l, struct gpu_buffer *buffer,
                                  bool nodes, void *from)
{
    return dense_transfer(gpu, l, buffer, from, nodes, false);
}

static inline uint64_t dense_bytes(struct gpu_buffer *const *all, size_t n)
{
    uint64_t sum = 0;
    for (size_t i = 0; i < n; i++)
        sum += all[i] ? gpu_buffer_count(all[i]) * gpu_buffer_item(all[i]) : 0;
    return sum;
}

/* What the solver has on the device, with coarse levels or without. */
static inline uint64_t stress_taken(const struct elastic *e, bool levels)
{
    const struct stress_lattice *l = &e->lattice;
    struct gpu_buffer *const own[] = {
        l->table, l->run, l->fill, l->list,    l->flags, l->place,         e->u,
        e->p,     e->q,   e->r,    e->scalars, e->marks, e->normal_stress, e->shear_stress};
    uint64_t sum = dense_bytes(own, sizeof own / sizeof *own);
    for (int n = 1; levels && n < e->levels.n; n++) {
        const struct stress_level *up = &e->levels.level[n];
        l = &up->lattice;
        struct gpu_buffer *const all[] = {l->table, l->run, l->fill, l->list,  l->flags,
                                          l->place, up->r,  up->z,   up->other};
        sum += dense_bytes(all, sizeof all / sizeof *all);
    }
    return sum;
}

/* Where node (i, j, k) is in a lattice that keeps everything. */
static inline uint32_t dense_place(const int c[3], int i, int j, int k)
{
    const int run = (k * (c[1] + 1) + j) * (c[0] / (int)STRESS_RUN + 1) + i / (int)STRESS_RUN;
    return (STRESS_FIRST + (uint32_t)run) * STRESS_RUN + (uint32_t)i % STRESS_RUN;
}

/* Such a lattice. */
static inline status dense_create(struct gpu *gpu, struct gpu_work *work, const int cells[3],
                                  struct stress_lattice *l)
{
    status st = OK;
    struct gpu_buffer *marks = NULL;
    TRY(lattice_create(gpu, cells, l));
    TRY(gpu_buffer_create(gpu, "marks", l->n_table + 1, 4, &marks));
    gpu_fill(gpu, marks, 1);
    TRY(lattice_choose(gpu, work, l, marks));
    lattice_table(gpu, l);
done:
    gpu_buffer_destroy(gpu, &marks);
    return st;
}

#endif
