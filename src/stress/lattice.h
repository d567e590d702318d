/* Where the stress grid's nodes and cells are kept: only where there is rock, in runs of STRESS_RUN along x.
 *
 * Runs       Those a filled cell's nodes are in, or next to in their row, are kept, in the order of the whole grid; a small
 *            table finds them (shaders/stress/grid.glsl). A cell is kept where its first node is. Buffers of values
 *            have lattice_items(): all kept runs, and three that are zero for what lies outside them.
 * Calling sequence   for a shape: marks; lattice_choose(), which lays the runs out anew; then, once nobody wants the old
 *            layout any more, lattice_table(); then fill; then lattice_activate().
 */
#ifndef HOODOO_STRESS_LATTICE_H
#define HOODOO_STRESS_LATTICE_H

#include "gpu/gpu.h"
#include "gpu/primitives.h"

struct stress_lattice {
    int cells[3];             /* with the margin: two more than the domain's */
    unsigned walls;           /* of the domain, WALL_*: set by the caller */
    size_t n_table;           /* runs of the whole grid */
    size_t n, room;           /* runs kept, and those there is room for */
    size_t n_active;          /* nodes that move */
    struct gpu_buffer *table; /* uint [n_table]: where each begins */
    struct gpu_buffer *run;   /* uint [slots]: which is kept there, or STRESS_NO_RUN */
    struct gpu_buffer
        *fill; /* float [items]: the cells' share of rock or, on coarser levels, of the full stiffness */
    struct gpu_buffer *list;          /* uint [n_active]: where the nodes that move are kept, ascending */
    struct gpu_buffer *flags, *place; /* scratch, a word for each item */
};

/* Runs of the whole grid. */
size_t lattice_runs(const int cells[3]);

/* Values that each buffer has room for, and the most that may be. */
size_t lattice_items(const struct stress_lattice *l);
size_t lattice_items_most(const int cells[3]);

/* About how many cells rock is in, how many of their faces are bare, and how many of these end a row along x. */
struct rock_size {
    uint64_t inside, bare, ends;
};

/* Bytes on the device for such a rock, with so many bytes of others' for each value. */
uint64_t lattice_bytes(const int cells[3], const struct rock_size *rock, uint64_t others);

/* Nothing is kept. */
MUST_USE status lattice_create(struct gpu *gpu, const int cells[3], struct stress_lattice *out);
void lattice_destroy(struct gpu *gpu, struct stress_lattice *l);

/* Keeps the runs that are marked with 1 (uint [n_table + 1], lost), as they will be found once lattice_table() has been
 * called. Values are lost where the room changes. Waits. */
MUST_USE status lattice_choose(struct gpu *gpu, struct gpu_work *work, struct stress_lattice *l,
                               struct gpu_buffer *marks);
void lattice_table(struct gpu *gpu, struct stress_lattice *l);

/* Finds the nodes that move, from the fill. Waits. */
MUST_USE status lattice_activate(struct gpu *gpu, struct gpu_work *work, struct stress_lattice *l);

/* For n invocations that only ask where things are. */
struct stress_params lattice_params(const struct stress_lattice *l, size_t n);

/* A buffer of the lattice's values, made anew and zero unless it has the right room. */
MUST_USE status lattice_buffer(struct gpu *gpu, const struct stress_lattice *l, const char *name, size_t item,
                               struct gpu_buffer **buffer);

#endif
